#include "trackbed/planning/path_file/path_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using ::testing::HasSubstr;

FittedPath Fit(std::vector<Vec2> points, const PathFitOptions& options = {}) {
  PathPoints given;
  given.points = std::move(points);
  return FitPath(std::move(given), options);
}

std::vector<Vec2> PointsOf(const Path& path, double spacing) {
  std::vector<Vec2> points;
  for (const PathPoint& point : path.Sample(spacing)) {
    points.push_back(point.pose.position());
  }
  return points;
}

constexpr PathFitOptions kClose{.max_deviation = 1e-5};

VehicleParams CarWithLimits() {
  VehicleParams car = ReferenceCar();
  car.friction_lateral = 0.8;
  car.top_speed = 40.0;
  return car;
}

// On a circle of radius R, friction limits the speed v to v^2/R = mu g, and roll-over limits it to
// v^2/R = a_r.
TEST(CheckPath, FindsTheSpeedOfACircle) {
  const VehicleParams car = CarWithLimits();
  constexpr double kRadius = 30.0;
  PathFitOptions closed = kClose;
  closed.closed = true;
  std::vector<Vec2> points =
      PointsOf(Path({}, {{.length = 2.0 * kPi * kRadius, .curvature = 1.0 / kRadius}}), 1.0);
  points.pop_back();
  const FittedPath fitted = Fit(points, closed);
  const PathCheck grip = CheckPath(fitted, car, {.speed = 8.0});
  EXPECT_TRUE(grip.drivable());
  // The spline stays within 1e-5 m of points 1 m apart, so the error of its curvature is small
  // compared with 1/30 1/m.
  EXPECT_NEAR(grip.max_speed, std::sqrt(0.8 * 9.81 * kRadius), Tolerance(0.02));
  EXPECT_EQ(grip.max_speed_limit, PathFaultKind::kFriction);
  const PathCheck tips = CheckPath(fitted, car, {.speed = 8.0, .rollover_acceleration = 5.0});
  EXPECT_NEAR(tips.max_speed, std::sqrt(5.0 * kRadius), Tolerance(0.02));
  EXPECT_EQ(tips.max_speed_limit, PathFaultKind::kRollOver);
  const PathCheck ice = CheckPath(fitted, car, {.speed = 8.0, .friction = 0.25});
  ASSERT_FALSE(ice.drivable());
  EXPECT_EQ(ice.faults[0].kind, PathFaultKind::kFriction);
  EXPECT_NEAR(ice.faults[0].required, 64.0 / kRadius, Tolerance(0.01));
  EXPECT_NEAR(ice.faults[0].limit, 0.25 * 0.8 * 9.81, Tolerance(1e-12));
  // The whole circle is one stretch with a fault.
  EXPECT_EQ(ice.faults.size(), 1U);
  EXPECT_NEAR(ice.faults[0].stations.to, fitted.path.length(), Tolerance(1e-9));
}

// The bend has the curvature kappa(s) = A (1 - cos(2 pi s/l))/2. The segments of the bend are 0.1 m
// long and have a quadratic curvature, which errs by less than 1e-5 A. The expected speed limit is
// the car's steering rate divided by the maximum of d delta/ds = L kappa'/(1 + (L kappa)^2).
TEST(CheckPath, FindsTheSteeringRateOfABend) {
  constexpr double kMaxCurvature = 0.1;
  constexpr double kLength = 60.0;
  const VehicleParams car = ReferenceCar();
  const auto curvature = [](double s) {
    return 0.5 * kMaxCurvature * (1.0 - std::cos(2.0 * kPi * s / kLength));
  };
  const auto slope = [&](double s) {
    const double rate = kMaxCurvature * kPi / kLength * std::sin(2.0 * kPi * s / kLength);
    return car.wheelbase * std::abs(rate) / (1.0 + std::pow(car.wheelbase * curvature(s), 2));
  };
  std::vector<CurvePoint> bend;
  double steepest = 0.0;
  for (int i = 0; i <= 600; ++i) {
    const double s = 0.1 * i;
    bend.push_back(
        {s, 0.5 * kMaxCurvature * (s - kLength / (2.0 * kPi) * std::sin(2.0 * kPi * s / kLength)),
         curvature(s)});
    steepest = s < 30.0 && slope(s) > slope(steepest) ? s : steepest;
  }
  const Path path({}, SegmentsThrough(bend));
  const FittedPath fitted = Fit(PointsOf(path, 0.5), kClose);
  const double expected = car.steering_rate / slope(steepest);
  const PathCheck check = CheckPath(fitted, car, {.speed = 1.05 * expected});
  // The check finds one fault at the entry of the bend and one fault at its exit.
  ASSERT_EQ(check.faults.size(), 2U);
  for (const PathFault& fault : check.faults) {
    EXPECT_EQ(fault.kind, PathFaultKind::kSteeringRate);
    EXPECT_EQ(fault.limit, car.steering_rate);
    // The spline deviates by at most 1e-5 m from points 0.5 m apart. This changes the curvature by
    // 4e-5 1/m, and the curvature rate by 1e-4 1/m^2. That is 2 % of the bend's rate of 0.0052
    // 1/m^2. The fitted curvature of the bend itself has a smaller error.
    EXPECT_NEAR(fault.required, 1.05 * car.steering_rate, Tolerance(0.02 * car.steering_rate));
    EXPECT_LT((fault.position - path.At(fault.s).pose.position()).norm(), 1e-3);
    EXPECT_GT(slope(fault.stations.from + 0.3), 0.97 / 1.05 * slope(steepest));
    EXPECT_GT(slope(fault.stations.to - 0.3), 0.97 / 1.05 * slope(steepest));
  }
  // The steering rate is within 2 % of its maximum up to 1.4 m before and behind the steepest
  // station.
  EXPECT_NEAR(check.faults[0].s, steepest, Tolerance(1.5));
  EXPECT_NEAR(check.faults[1].s, kLength - steepest, Tolerance(1.5));
  EXPECT_NEAR(check.max_speed, expected, Tolerance(2e-2 * expected));
  EXPECT_TRUE(CheckPath(fitted, car, {.speed = 0.97 * expected}).drivable());
}

TEST(CheckPath, FindsSteeringBeyondTheCarsAngle) {
  const VehicleParams car = ReferenceCar();  // turning radius 5.1 m
  const Path path({}, {{.length = 20.0},
                       {.length = 6.0, .sharpness = 0.25 / 6.0},
                       {.length = 6.0, .curvature = 0.25, .sharpness = -0.25 / 6.0},
                       {.length = 20.0}});
  const PathCheck check = CheckPath(Fit(PointsOf(path, 0.25), kClose), car, {.speed = 0.05});
  ASSERT_EQ(check.faults.size(), 1U);
  EXPECT_EQ(check.faults[0].kind, PathFaultKind::kSteeringAngle);
  EXPECT_NEAR(check.faults[0].s, 26.0, Tolerance(0.3));
  EXPECT_NEAR(check.faults[0].limit, car.steering_limit, Tolerance(1e-12));
  // The curvature exceeds 1/5.1 1/m within 6 (1 - 0.196/0.25) m = 1.294 m on either side of the
  // peak.
  EXPECT_NEAR(check.faults[0].stations.from, 26.0 - 1.294, Tolerance(0.15));
  EXPECT_NEAR(check.faults[0].stations.to, 26.0 + 1.294, Tolerance(0.15));
  EXPECT_EQ(check.max_speed, 0.0);
  EXPECT_EQ(check.max_speed_limit, PathFaultKind::kSteeringAngle);
}

TEST(CheckPath, NamesEveryJumpOfAPolyline) {
  const FittedPath fitted =
      Fit({{0.0, 0.0}, {10.0, 0.0}, {20.0, 1.0}, {30.0, 1.0}}, {.fit = PathFit::kPolyline});
  const PathCheck check = CheckPath(fitted, ReferenceCar(), {.speed = 1.0});
  ASSERT_EQ(check.faults.size(), 2U);
  EXPECT_EQ(check.faults[0].kind, PathFaultKind::kHeadingJump);
  EXPECT_EQ(check.faults[0].position, Vec2(10.0, 0.0));
  EXPECT_NEAR(check.faults[0].required, std::atan(0.1), Tolerance(1e-12));
  EXPECT_EQ(check.faults[1].position, Vec2(20.0, 1.0));
  EXPECT_EQ(check.max_speed, 0.0);
  EXPECT_THAT(ToString(check.faults[0]), HasSubstr("heading jumps by 0.0997 rad at s = 10 m"));
  const FittedPath straight =
      Fit({{0.0, 0.0}, {10.0, 0.0}, {20.0, 0.0}}, {.fit = PathFit::kPolyline});
  EXPECT_TRUE(CheckPath(straight, ReferenceCar(), {.speed = 1.0}).drivable());
}

TEST(CheckPath, NamesWhereAPathTurnsBack) {
  const PathCheck check = CheckPath(Fit({{0.0, 0.0}, {5.0, 0.0}, {8.0, 4.0}, {5.0, 0.1}}),
                                    ReferenceCar(), {.speed = 1.0});
  ASSERT_EQ(check.faults.size(), 1U);
  EXPECT_EQ(check.faults[0].kind, PathFaultKind::kReversal);
  EXPECT_EQ(check.faults[0].position, Vec2(8.0, 4.0));
  EXPECT_NEAR(check.faults[0].s, 10.0, Tolerance(1e-12));
  EXPECT_TRUE(check.demands.empty());
}

TEST(CheckPath, NamesASpeedBeyondTheCars) {
  const PathCheck check =
      CheckPath(Fit({{0.0, 0.0}, {100.0, 0.0}}), CarWithLimits(), {.speed = 41.0});
  ASSERT_EQ(check.faults.size(), 1U);
  EXPECT_EQ(check.faults[0].kind, PathFaultKind::kTopSpeed);
  EXPECT_EQ(check.max_speed, 40.0);
  EXPECT_THROW(CheckPath(Fit({{0.0, 0.0}, {1.0, 0.0}}), ReferenceCar(), {.speed = 0.0}),
               PreconditionError);
}

TEST(RollOverAcceleration, IsThatOfARigidCar) {
  EXPECT_NEAR(RollOverAcceleration(1.5, 0.5), 1.5 * 9.81, Tolerance(1e-12));
  EXPECT_THROW(RollOverAcceleration(1.5, 0.0), PreconditionError);
}

}  // namespace
}  // namespace trackbed
