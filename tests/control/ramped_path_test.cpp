#include "src/control/ramped_path.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/control/loop.h"
#include "tests/support/case_names.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace ramped_path_test {

constexpr double kRadius = 8.0;  // [m]
constexpr double kSpeed = 3.0;   // [m/s]

/// A straight of 60 m, a left turn of 180 degrees, and a straight of 60 m.
Path Turn(int direction) {
  return Path({}, {{60.0, 0.0, direction},
                   {std::numbers::pi * kRadius, 1.0 / kRadius, direction},
                   {60.0, 0.0, direction}});
}

/// Length of the ramp at the beginning of Turn [m].
double RampOf(const VehicleParams& car) {
  return kSpeed * std::atan(car.wheelbase / kRadius) / car.steering_rate;
}

/// Inputs of a controller on a path, for as long as this object exists.
struct RampedPathCase {
  VehicleParams car = ReferenceCar();
  Reference reference;
  SteeringSchedule schedule;

  explicit RampedPathCase(Path path) : reference{std::move(path), SpeedProfile({{0.0, kSpeed}})} {}

  [[nodiscard]] ControlInput At(double station, int direction) const {
    VehicleState state;
    state.pose = reference.path.At(station).pose;
    state.speed = direction * kSpeed;
    return {.vehicle = car,
            .reference = reference,
            .schedule = schedule,
            .state = state,
            .station = station,
            .period = 0.02};
  }
};

class RampedPathIn : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Directions, RampedPathIn, testing::Values(1, -1), kNamedByParameter);

TEST_P(RampedPathIn, IsACurveWithItsOwnHeadingAndCurvature) {
  // Central differences of points 2 h = 2 cm apart have an error of h^2/6 times the third
  // derivative, which is below 2 kappa/S = 0.04 1/m^2: 1e-6. To first order, the ramped path turns
  // from the path by psi = de/ds. The exact angle is atan(psi/(1 - kappa e)). It differs by at most
  // psi^3/3 and psi kappa e/(1 - kappa e), where e is at most kappa S^2/24 = 0.22 m. The curvature
  // is the derivative of the heading, but for the corners of the curvature at both ends of the ramp
  // and at the step, where the central difference is off by kappa/S h = 2e-4.
  const RampedPathCase at(Turn(GetParam()));
  const ControlInput input = at.At(60.0, GetParam());
  RampedPath ramped;
  ramped.Update(input, 30.0);
  constexpr double h = 0.01;
  for (double s = 45.1; s < 75.0; s += 0.37) {
    const PathPoint before = ramped.At(s - h);
    const PathPoint here = ramped.At(s);
    const PathPoint after = ramped.At(s + h);
    const Vec2 chord = GetParam() * (after.pose.position() - before.pose.position());
    const PathPoint beside = at.reference.path.At(s);
    const double psi = std::abs(AngleDifference(here.pose.yaw, beside.pose.yaw));
    const double beyond = std::abs(beside.curvature) * 0.22;
    EXPECT_NEAR(AngleDifference(std::atan2(chord.y(), chord.x()), here.pose.yaw), 0.0,
                Tolerance(1e-6 + psi * psi * psi / 3.0 + psi * beyond / (1.0 - beyond)))
        << s;
    const double turned = GetParam() * AngleDifference(after.pose.yaw, before.pose.yaw);
    EXPECT_NEAR(turned / (2.0 * h), here.curvature, Tolerance(2e-4)) << s;
  }
}

TEST_P(RampedPathIn, TurnsTheWheelsAcrossAStepWithinTheirRate) {
  const RampedPathCase at(Turn(GetParam()));
  const double ramp = RampOf(at.car);
  const ControlInput input = at.At(60.0, GetParam());
  RampedPath ramped;
  ramped.Update(input, 40.0);
  // By symmetry, half of the curvature is reached at the step, where the path is left by the
  // integral of the ramp, kappa S/8, and crossed.
  const PathPoint middle = ramped.At(60.0);
  EXPECT_NEAR(middle.curvature, 0.5 / kRadius, Tolerance(1e-12));
  EXPECT_NEAR(middle.pose.yaw, GetParam() * ramp / (8.0 * kRadius), Tolerance(1e-12));
  EXPECT_NEAR(middle.pose.y, 0.0, Tolerance(1e-12));
  // Between neighboring points, the wheels turn by omega h/v on the ramp in the mean. The tangent
  // makes the rate differ along the ramp, by up to 1 + (L kappa)^2 = 1.114.
  constexpr double h = 0.01;
  double fastest = 0.0;
  for (double s = 30.0; s < 72.0; s += h) {
    const double turned = SteeringForCurvature(at.car, ramped.At(s + h).curvature) -
                          SteeringForCurvature(at.car, ramped.At(s).curvature);
    fastest = std::max(fastest, std::abs(turned) * kSpeed / h);
  }
  EXPECT_LT(fastest, 1.12 * at.car.steering_rate);
  EXPECT_GT(fastest, 0.9 * at.car.steering_rate);
}

TEST(RampedPath, LeavesAPathWithoutStepsAlone) {
  // The curvature is continuous: 0.1 1/m is reached over 10 m.
  const RampedPathCase at(Path({}, {{20.0, 0.0, 1}, {10.0, 0.0, 1, 0.01}, {20.0, 0.1, 1}}));
  const ControlInput input = at.At(15.0, 1);
  RampedPath ramped;
  ramped.Update(input, 40.0);
  for (double s = 0.5; s < 50.0; s += 1.0) {
    const PathPoint wanted = at.reference.path.At(s);
    const PathPoint point = ramped.At(s);
    EXPECT_EQ(point.pose, wanted.pose);
    EXPECT_EQ(point.curvature, wanted.curvature);
  }
}

TEST(RampedPath, PassesThroughEndsAndCusps) {
  // The steps are 3 m before the cusp and 2 m before the end; their ramps would be longer.
  const RampedPathCase at(
      Path({}, {{30.0, 0.0, 1}, {3.0, 0.1, 1}, {25.0, 0.0, -1}, {2.0, 0.15, -1}}));
  const ControlInput input = at.At(20.0, 1);
  RampedPath ramped;
  ramped.Update(input, 60.0);
  for (const double s : {33.0, 60.0}) {
    for (const double side : {-1e-9, 1e-9}) {
      // A polynomial of degree 5 is flat at its end.
      const Vec2 off =
          ramped.At(s + side).pose.position() - at.reference.path.At(s + side).pose.position();
      EXPECT_NEAR(off.norm(), 0.0, Tolerance(1e-12)) << s;
    }
  }
  EXPECT_GT((ramped.At(28.0).pose.position() - at.reference.path.At(28.0).pose.position()).norm(),
            1e-3);
}

TEST(RampedPath, TurnsTheWheelsWithinTheirRateNearAnEnd) {
  // Between the end and the step, there is room for half of the ramp, but not for a tail. The whole
  // sideways shift kappa S^2/24 is on the other side of the step.
  const double ramp = RampOf(ReferenceCar());
  for (const bool at_start : {true, false}) {
    const Segment arc{0.6 * ramp, 1.0 / kRadius, 1};
    const Segment straight{60.0, 0.0, 1};
    const RampedPathCase at(at_start ? Path({}, {arc, straight}) : Path({}, {straight, arc}));
    const double step = at_start ? arc.length : straight.length;
    const ControlInput input = at.At(step, 1);
    RampedPath ramped;
    ramped.Update(input, 60.0);
    constexpr double h = 0.01;
    for (double s = 0.0; s + h < at.reference.path.length(); s += h) {
      const double turned = SteeringForCurvature(at.car, ramped.At(s + h).curvature) -
                            SteeringForCurvature(at.car, ramped.At(s).curvature);
      EXPECT_LT(std::abs(turned) * kSpeed / h, 1.12 * at.car.steering_rate) << s;
    }
    const double before = step + (at_start ? -0.5 : 0.5) * ramp;
    const double behind = step + (at_start ? 0.5 : -0.5) * ramp;
    const auto offset = [&](double s) {
      return (ramped.At(s).pose.position() - at.reference.path.At(s).pose.position()).norm();
    };
    // The share of a side grows with the cube of its tail, here 0.1 S and 2 S.
    EXPECT_LT(offset(before), 0.001 * ramp * ramp / (24.0 * kRadius));
    EXPECT_GT(offset(behind), 0.999 * ramp * ramp / (24.0 * kRadius));
  }
}

class FollowerOfSteps : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Laws, FollowerOfSteps,
                         testing::Values("lqr", "stanley", "rear_axle_feedback", "preview",
                                         "preview_integral"),
                         [](const auto& law) { return std::string(law.param); });

TEST_P(FollowerOfSteps, StaysOnATurnLeftAndATurnRight) {
  // Two right angles of 7.2 m with a straight of twice the ramp between them: the route on which
  // lqr left its path by 4.2 m, stanley by 15 m, and rear_axle_feedback by 3.5 m. A ramp moves the
  // path by kappa S^2/24 in all. The error is at most this distance, and a tenth for the turns of
  // the wheels that the feedback adds.
  LoopSetup setup;
  setup.speed = 3.27;
  setup.duration = 25.0;
  const double curvature = 1.0 / 7.17;
  const double ramp =
      setup.speed * std::atan(setup.vehicle.wheelbase * curvature) / setup.vehicle.steering_rate;
  const double arc = 0.5 * std::numbers::pi / curvature;
  setup.path = Path({}, {{25.0, 0.0, 1},
                         {arc, curvature, 1},
                         {2.0 * ramp, 0.0, 1},
                         {arc, -curvature, 1},
                         {30.0, 0.0, 1}});
  const auto entry = std::find_if(
      Controllers().begin(), Controllers().end(),
      [](const ControllerEntry& each) { return std::string(each.name) == GetParam(); });
  ASSERT_NE(entry, Controllers().end());
  EXPECT_LT(LargestOffset(Loop(entry->defaults, setup)), 1.1 * curvature * ramp * ramp / 24.0);
}

}  // namespace ramped_path_test
}  // namespace trackbed
