#include "src/control/timely_steering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/control/loop.h"
#include "tests/tolerance.h"

namespace trackbed {
namespace timely_steering_test {

constexpr double kSpeed = 3.0;  // [m/s]

/// Steers on a path, at a station, by a law.
double SteerBy(const Path& path, double station,
               const std::function<double(const GainedErrors&)>& law) {
  const VehicleParams car = ReferenceCar();
  const Reference reference{path, SpeedProfile({{0.0, kSpeed}})};
  const SteeringSchedule schedule;
  VehicleState state;
  state.pose = path.At(station).pose;
  state.speed = kSpeed;
  const ControlInput input{.vehicle = car,
                           .reference = reference,
                           .schedule = schedule,
                           .state = state,
                           .station = station,
                           .period = 0.02};
  RampedPath ramped;
  ramped.Update(input, TimelySteering::Horizon(input));
  return TimelySteering().Steer(input, ramped, false, law({}), law);
}

TEST(TimelySteering, SolvesTheReturnToAStraightPath) {
  // Wheels that return from delta to 0 at the rate omega turn the car by
  //   psi = v/(L omega) int_0^delta tan(x) dx = -v/(L omega) ln(cos(delta)).
  // The law a - g psi meets the angle where a - g psi(delta) = delta. TimelySteering integrates by
  // the trapezoidal rule, in steps of h = 0.487/40 rad. The error of the integral is at most delta
  // h^2/12 times the second derivative of tan, 2 tan sec^2 < 1.4, plus that of the last step,
  // where the angle falls to 0 linearly: at most h^3. Together they are below 1e-5, and g v/(L
  // omega) is at most 15.
  const VehicleParams car = ReferenceCar();
  const double way = kSpeed / (car.wheelbase * car.steering_rate);
  const Path straight({}, {{200.0, 0.0, 1}});
  for (const double gain : {0.1, 0.5, 2.0}) {
    for (const double wanted : {0.02, 0.1, 0.3, 0.48}) {
      for (const double side : {1.0, -1.0}) {
        const auto unsolved = [&](double delta) {
          return wanted + gain * way * std::log(std::cos(delta)) - delta;
        };
        std::uintmax_t iterations = 100;
        const auto [low, high] = boost::math::tools::toms748_solve(
            unsolved, 0.0, wanted, boost::math::tools::eps_tolerance<double>(50), iterations);
        const double steering = SteerBy(straight, 5.0, [&](const GainedErrors& gained) {
          return side * wanted - gain * gained.heading;
        });
        EXPECT_NEAR(steering, side * 0.5 * (low + high), Tolerance(15.0 * 1e-5))
            << gain << " " << wanted;
      }
    }
  }
}

TEST(TimelySteering, LeavesASmallCorrectionToTheLaw) {
  // A correction of 1 mrad gains psi = v/(L omega) delta^2/2 = 3.7e-6 rad.
  const Path straight({}, {{200.0, 0.0, 1}});
  const double steering = SteerBy(straight, 5.0, [](const GainedErrors& gained) {
    return 1e-3 - gained.heading - gained.cross_track;
  });
  EXPECT_NEAR(steering, 1e-3, Tolerance(2e-5));
}

TEST(TimelySteering, SteersByThePathWhereItsWheelsTurnBackAtTheirFullRate) {
  // The path turns the wheels from 0.4 rad to 0 at their full rate within 8 m. Wheels that are
  // ahead by d remain so to the end, and the car then gains at least psi = d/L times 8 m. With the
  // law a - psi, where a is 0.3 rad above the path's steering, d (1 + 8/2.7) is at most 0.3 rad.
  const VehicleParams car = ReferenceCar();
  const double ramp = 0.4 * kSpeed / car.steering_rate;
  const double curvature = std::tan(0.4) / car.wheelbase;
  const Path path({},
                  {{10.0, curvature, 1}, {ramp, curvature, 1, -curvature / ramp}, {60.0, 0.0, 1}});
  const double ahead = 0.3;
  const auto law = [&](const GainedErrors& gained) { return 0.4 + ahead - gained.heading; };
  const double steering = SteerBy(path, 10.0, law) - 0.4;
  EXPECT_GT(steering, 0.0);
  EXPECT_LT(steering, ahead / (1.0 + ramp / car.wheelbase));
  // Wheels that must turn further in the direction of the path are never late by the rule.
  const auto right = [&](const GainedErrors& gained) { return 0.2 - gained.heading; };
  EXPECT_GE(SteerBy(path, 10.0, right), 0.2);
}

class FollowerAtFullRate : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Laws, FollowerAtFullRate,
                         testing::Values("preview", "preview_integral", "pure_pursuit", "stanley",
                                         "rear_axle_feedback", "lqr", "mpc"),
                         [](const auto& law) { return std::string(law.param); });

TEST_P(FollowerAtFullRate, TurnsItsWheelsBackInTime) {
  // The path turns the wheels from side to side at 0.9 of their rate, so little rate is left to
  // correct the error of the start. A law that feeds back errors without regard to its wheels
  // swings ever further. The error is at most that of the start, plus the R^2/(8 r) by which a law
  // that aims at a point at the distance R cuts a bend of radius r (pure_pursuit.h).
  LoopSetup setup;
  const double most = std::tan(0.4) / setup.vehicle.wheelbase;
  const double ramp = 0.8 * setup.speed / (0.9 * setup.vehicle.steering_rate);
  std::vector<Segment> segments{{20.0, 0.0, 1}, {0.5 * ramp, 0.0, 1, 2.0 * most / ramp}};
  for (const double from : {most, -most, most, -most}) {
    segments.push_back({ramp, from, 1, -2.0 * from / ramp});
  }
  segments.push_back({0.5 * ramp, most, 1, -2.0 * most / ramp});
  segments.push_back({20.0, 0.0, 1});
  setup.path = Path({}, segments);
  const double offset = 0.3;
  setup.start = {18.0, offset, 0.0};
  setup.duration = 30.0;
  const double distance =
      1.5 * std::cbrt(offset * setup.vehicle.wheelbase * setup.speed / setup.vehicle.steering_rate);
  const auto entry = std::find_if(
      Controllers().begin(), Controllers().end(),
      [](const ControllerEntry& each) { return std::string(each.name) == GetParam(); });
  ASSERT_NE(entry, Controllers().end());
  EXPECT_LT(LargestOffset(Loop(entry->defaults, setup)), offset + distance * distance * most / 8.0);
}

}  // namespace timely_steering_test
}  // namespace trackbed
