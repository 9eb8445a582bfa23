#include "src/control/preview_distance.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "src/control/tracking.h"
#include "tests/control/loop.h"
#include "tests/tolerance.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/preview.h"
#include "trackbed/control/preview_integral.h"
#include "trackbed/control/pure_pursuit.h"
#include "trackbed/control/stanley.h"
#include "trackbed/control/steering_controller.h"

namespace trackbed {
namespace preview_distance_test {

constexpr double kPeriod = 0.02;  // [s]
/// Bound on the rounding errors of a distance of some meters after a few operations [m].
constexpr double kRounding = 1e-12;

double Distance(const VehicleParams& vehicle, const Path& path, double station, double speed,
                double delay = 0.0) {
  const Reference reference{path, {}};
  VehicleState state;
  state.pose = path.At(station).pose;
  state.speed = speed;
  return PreviewDistance({.vehicle = vehicle,
                          .reference = reference,
                          .schedule = {},
                          .state = state,
                          .station = station,
                          .period = kPeriod},
                         delay);
}

/// Ramp distance S [m]: the distance that the car covers while its wheels turn from one curvature
/// to another.
double Ramp(const VehicleParams& car, double before, double after, double speed) {
  return speed * std::abs(std::atan(car.wheelbase * after) - std::atan(car.wheelbase * before)) /
         car.steering_rate;
}

TEST(TyreDelay, IsThatOfTheLinearSingleTrackCarWhoseWheelsTurnSteadily) {
  // With tan(delta) = a t, the curvature of the rear axle's path becomes a (t - T_t)/(L + K v^2)
  // after the transients. Here, the equations of the car are integrated by Heun's method.
  const VehicleParams car = ReferenceCarWithTyres();
  const double understeer = car.mass / car.wheelbase *
                            (car.cg_to_rear / car.cornering_stiffness_front -
                             car.cg_to_front() / car.cornering_stiffness_rear);
  const double a = 0.01;     // [1/s]
  const double step = 1e-4;  // [s]
  const double until = 3.0;  // The slowest transient decays by exp(-4.5/s times 3 s) = 1e-6.
  for (const double speed : {3.0, 7.0, 15.0}) {
    const auto rates =
        LateralRates(car, {car.cornering_stiffness_front, car.cornering_stiffness_rear}, speed);
    const auto change = [&](const Eigen::Vector2d& motion, double t) {
      return Eigen::Vector2d(rates * Eigen::Vector3d(motion(0), motion(1), a * t));
    };
    Eigen::Vector2d motion = Eigen::Vector2d::Zero();  // lateral speed, yaw rate
    for (int i = 0; i < std::lround(until / step); ++i) {
      const Eigen::Vector2d first = change(motion, i * step);
      const Eigen::Vector2d second = change(motion + step * first, (i + 1) * step);
      motion += 0.5 * step * (first + second);
    }
    // The rear axle moves in the direction yaw + (v_y - l_r r)/v.
    const Eigen::Vector2d last = change(motion, until);
    const double curvature = (motion(1) + (last(0) - car.cg_to_rear * last(1)) / speed) / speed;
    const double delay = until - curvature * (car.wheelbase + understeer * speed * speed) / a;
    EXPECT_NEAR(TyreDelay(car, speed), delay, Tolerance(1e-5)) << speed;
  }
  EXPECT_EQ(TyreDelay(ReferenceCar(), 3.0), 0.0);
}

TEST(PreviewDistance, OnAStraightIsThreeQuartersOfTheWheelbaseOrThreeResponses) {
  const Path straight({}, {{200.0, 0.0, 1}});
  EXPECT_NEAR(Distance(ReferenceCar(), straight, 50.0, 3.0), 0.75 * 2.7, Tolerance(kRounding));
  // At high speed and without tyre stiffnesses, the distance is 3 v T with the response time T =
  // 0.02 s.
  EXPECT_NEAR(Distance(ReferenceCar(), straight, 50.0, 60.0), 3.0 * 60.0 * 0.02,
              Tolerance(kRounding));
  // With tyre stiffnesses, the response time is the period plus the steering lag plus m v/(C_f +
  // C_r): T = 0.02 + 0.01 + 1317 * 20/(90000 + 110000) = 0.1617 s.
  const VehicleParams car = ReferenceCarWithTyres();
  EXPECT_NEAR(ResponseTime(car, 20.0, kPeriod), 0.1617, Tolerance(kRounding));
  EXPECT_NEAR(Distance(car, straight, 50.0, 20.0), 3.0 * 20.0 * 0.1617, Tolerance(kRounding));
  EXPECT_NEAR(Distance(car, straight, 50.0, 20.0, 0.2), 3.0 * 20.0 * 0.3617, Tolerance(kRounding));
  EXPECT_EQ(Distance(car, Path({}, {{200.0, 0.0, -1}}), 50.0, -20.0),
            Distance(car, straight, 50.0, 20.0));
}

TEST(PreviewDistance, ReachesAStepOfCurvatureAsFarAsTheRampAsks) {
  const VehicleParams car = ReferenceCar();
  for (const double curvature : {0.05, -0.12}) {
    for (const int direction : {1, -1}) {
      const Path path({}, {{50.0, 0.0, direction}, {50.0, curvature, direction}});
      const double speed = 5.0 * direction;
      const double wanted = 0.65 * Ramp(car, 0.0, curvature, 5.0) + 5.0 * kPeriod;
      ASSERT_GT(wanted, 1.1 * 0.75 * car.wheelbase);
      SCOPED_TRACE(fmt::format("curvature {}, direction {}", curvature, direction));
      // The longer preview distance R = `wanted` applies within R of the step on either side. The
      // rule may underestimate the distance to a step by up to 30 %.
      for (const double share : {-0.99, -0.5, -0.1, 0.0, 0.1, 0.5, 0.99}) {
        EXPECT_NEAR(Distance(car, path, 50.0 + share * wanted, speed), wanted, Tolerance(kRounding))
            << share;
      }
      for (const double share : {-1.31, 1.31}) {
        EXPECT_NEAR(Distance(car, path, 50.0 + share * wanted, speed), 0.75 * car.wheelbase,
                    Tolerance(kRounding))
            << share;
      }
    }
  }
}

TEST(PreviewDistance, AddsStepsThatTheWheelsHaveNotTheTimeFor) {
  // The path turns left and then right, with a straight of length `gap` between. The straight is
  // too short for the wheels to turn from one side to the other. The rule samples stations at
  // intervals of up to 0.3 of their distance from the car, so the result may ignore the gap.
  const VehicleParams car = ReferenceCar();
  const double speed = 5.0;
  const double one = Ramp(car, 0.0, 0.1, speed);
  const double gap = 2.0;
  const Path path({}, {{50.0, 0.1, 1}, {gap, 0.0, 1}, {50.0, -0.1, 1}});
  const double distance = Distance(car, path, 51.0, speed);
  EXPECT_GE(distance, 0.65 * (2.0 * one - gap) + speed * kPeriod - Tolerance(kRounding));
  EXPECT_LE(distance, 0.65 * 2.0 * one + speed * kPeriod + Tolerance(kRounding));
}

TEST(PreviewDistance, IsShortWhereTheWheelsCanFollow) {
  // The curvature ramps of the path need at most 0.8 of the steering rate, so the ramp distance S
  // is 0.
  const VehicleParams car = ReferenceCar();
  const double speed = 5.0;
  const double sharpness = 0.8 * car.steering_rate / (car.wheelbase * speed);
  const double length = 0.1 / sharpness;
  const Path path({}, {{.length = 30.0},
                       {.length = length, .sharpness = sharpness},
                       {.length = 30.0, .curvature = 0.1},
                       {.length = 2.0 * length, .curvature = 0.1, .sharpness = -sharpness},
                       {.length = 30.0, .curvature = -0.1}});
  for (double s = 0.0; s < path.length(); s += 0.37) {
    EXPECT_NEAR(Distance(car, path, s, speed), 0.75 * car.wheelbase, Tolerance(kRounding)) << s;
  }
}

TEST(PreviewDistance, LooksNeitherBeyondTheEndsNorOverACusp) {
  // Beyond its ends a path is straight. At a cusp the wheels turn while the car is at rest.
  const VehicleParams car = ReferenceCar();
  const Path arc({}, {{20.0, 0.1, 1}});
  const Path cusp({}, {{20.0, 0.1, 1}, {20.0, -0.1, -1}});
  for (const double s : {0.0, 0.5, 10.0, 19.9, 20.0}) {
    EXPECT_NEAR(Distance(car, arc, s, 5.0), 0.75 * car.wheelbase, Tolerance(kRounding)) << s;
  }
  for (const double s : {19.5, 20.5}) {
    EXPECT_NEAR(Distance(car, cusp, s, 5.0), 0.75 * car.wheelbase, Tolerance(kRounding)) << s;
  }
}

/// Largest cross-track error [m] on a turn by `heading` with radius `radius` between straights.
double ErrorOnTurn(const ControllerOptions& options, const VehicleParams& car, double radius,
                   double heading, double speed, double period = kPeriod) {
  const double straight = 3.0 * radius;
  LoopSetup setup;
  setup.vehicle = car;
  setup.path =
      Path({}, {{straight, 0.0, 1}, {radius * heading, 1.0 / radius, 1}, {2.0 * straight, 0.0, 1}});
  setup.speed = speed;
  setup.period = period;
  setup.duration = 0.9 * setup.path.length() / speed;
  return LargestOffset(Loop(options, setup));
}

/// A model car at scale 1:10 whose wheels turn four times as fast.
VehicleParams TenthOfACar() {
  VehicleParams car = ReferenceCar();
  car.wheelbase *= 0.1;
  car.cg_to_rear *= 0.1;
  car.steering_rate *= 4.0;
  return car;
}

TEST(PreviewDistance, ErrorsScaleWithTheCar) {
  // Lengths scale by 1/10 and times by 1/4. The ratio v/(L omega) of the speed v to the wheelbase L
  // times the steering rate omega is the same, so both motions have the same shape.
  for (const ControllerOptions& options :
       {ControllerOptions(PreviewOptions{}), ControllerOptions(PreviewIntegralOptions{}),
        ControllerOptions(PurePursuitOptions{}), ControllerOptions(StanleyOptions{})}) {
    SCOPED_TRACE(ControllerFor(options).name);
    const double large = ErrorOnTurn(options, ReferenceCar(), 20.0, 1.6, 2.0);
    const double small = ErrorOnTurn(options, TenthOfACar(), 2.0, 1.6, 0.8, 0.25 * kPeriod);
    EXPECT_GT(large, 1e-3);
    // The search for the point ahead is accurate to 1e-13 of the station. The closed loop is
    // stable, so this error does not grow.
    EXPECT_NEAR(small, 0.1 * large, Tolerance(1e-9));
  }
}

TEST(PreviewDistance, KeepsATenthOfACarOnItsCorner) {
  // A right-angle turn of radius r = 1.7 m at 0.8 m/s, as in tests/data/small_three_turns.yaml.
  // While the wheels turn, the car covers S = 0.21 m and deviates from the path by S^2/(24 r) = 1.1
  // mm. A preview distance of R = 0.2 m cuts the corner by up to R^2/(8 r) = 3 mm.
  EXPECT_LT(ErrorOnTurn(PreviewOptions{}, TenthOfACar(), 1.7, 1.57, 0.8), 0.005);
  EXPECT_GT(ErrorOnTurn(PreviewOptions{.distance = 2.5}, TenthOfACar(), 1.7, 1.57, 0.8), 0.1);
}

TEST(PreviewDistance, KeepsTheCarInASharpSlowTurn) {
  // A turn by 170 degrees with the radius r = 5.2 m, near full lock, at 1 m/s. While the wheels
  // turn, the car covers S = 3.3 m and deviates from the path by S^2/(24 r) = 0.09 m.
  EXPECT_LT(ErrorOnTurn(PreviewOptions{}, ReferenceCar(), 5.2, 2.97, 1.0), 0.15);
  // At twice the speed, S doubles, so the car deviates by 0.35 m. A fixed preview distance of 2.5 m
  // overshoots.
  const double fast = ErrorOnTurn(PreviewOptions{}, ReferenceCar(), 5.2, 2.97, 2.0);
  EXPECT_LT(fast, 2.0 * 0.35);
  EXPECT_GT(ErrorOnTurn(PreviewOptions{.distance = 2.5}, ReferenceCar(), 5.2, 2.97, 2.0),
            1.4 * fast);
}

TEST(ReturnDistance, KeepsTheArcToThePathWithinHalfOfTheGrip) {
  // The wheels turn so fast that only the grip limits the return. From the offset e, the arc to a
  // point of the path at the distance R has the curvature 2 e/R^2.
  VehicleParams car = ReferenceCar();
  car.steering_rate = 1e6;
  EXPECT_LT(ReturnDistance(car, 16.0, 2.0), 5.0);  // unknown grip
  car.friction_lateral = 0.9;
  for (const double offset : {0.1, -0.5, 3.0}) {
    const double distance = ReturnDistance(car, 16.0, offset);
    const double curvature = 2.0 * std::abs(offset) / (distance * distance);
    EXPECT_NEAR(16.0 * 16.0 * curvature, 0.45 * kGravity, Tolerance(1e-9));
  }
}

TEST(HeldPreviewDistance, NeverMovesThePointBackwards) {
  const VehicleParams car = ReferenceCar();
  // A right angle with 10 m before and after it, on the car's arc of 9.46 m.
  const Path path({}, {{10.0, 0.0, 1}, {15.0, 0.1057, 1}, {10.0, 0.0, 1}});
  const Reference reference{path, {}};
  const double speed = 3.0;
  HeldPreviewDistance held;
  double point = 0.0;     // Station of the preview point [m].
  double steepest = 0.0;  // Largest decrease of PreviewDistance in a period [m].
  double last = Distance(car, path, 0.0, speed);
  const double step = speed * kPeriod;
  for (double station = 0.0; station < path.length(); station += step) {
    VehicleState state;
    state.pose = path.At(station).pose;
    state.speed = speed;
    const double distance = held.Next({.vehicle = car,
                                       .reference = reference,
                                       .schedule = {},
                                       .state = state,
                                       .station = station,
                                       .period = kPeriod});
    const double wanted = Distance(car, path, station, speed);
    EXPECT_GE(distance, wanted);
    EXPECT_GE(station + distance, point - kRounding) << "at " << station;
    point = station + distance;
    steepest = std::max(steepest, last - wanted);
    last = wanted;
  }
  EXPECT_GT(steepest, 10.0 * step);  // PreviewDistance itself jumps back.
  EXPECT_NEAR(point - path.length(), last, step);
}

}  // namespace preview_distance_test
}  // namespace trackbed
