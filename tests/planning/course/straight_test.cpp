#include "trackbed/planning/course/straight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"

namespace trackbed {
namespace {

// Ten times the rounding error [m] of positions, which are sums and products of a few numbers below
// 1e3.
constexpr double kLineRounding = 1e-12;

PlanRequest StraightRequest() {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.start = {3.0, -4.0, 0.6};
  request.speed = {.speed = 10.0, .acceleration = 2.0, .deceleration = 4.0};
  return request;
}

Plan PlanStraight(const PlanRequest& request, double length) {
  return StraightPlanner().plan(request, StraightOptions{.length = length});
}

TEST(Straight, LeadsAlongTheHeadingOfTheStart) {
  const PlanRequest request = StraightRequest();
  for (const double length : {0.01, 1.0, 7.5, 50.0, 812.0}) {
    const Plan plan = PlanStraight(request, length);
    ASSERT_TRUE(plan.ok()) << plan.reason;
    const Path& path = plan.reference.path;
    EXPECT_EQ(path.At(0.0).pose, request.start);
    EXPECT_NEAR(path.length(), length, Tolerance(kLineRounding));
    for (const double share : {0.25, 0.5, 1.0}) {
      const PathPoint point = path.At(share * length);
      EXPECT_NEAR(point.pose.x, 3.0 + share * length * std::cos(0.6), Tolerance(kLineRounding));
      EXPECT_NEAR(point.pose.y, -4.0 + share * length * std::sin(0.6), Tolerance(kLineRounding));
      EXPECT_EQ(point.pose.yaw, 0.6);
      EXPECT_EQ(point.curvature, 0.0);
    }
    EXPECT_EQ(plan.goal, path.At(length).pose);
    EXPECT_EQ(plan.schedule.At(0.5 * length), 0.0);
  }
}

TEST(Straight, HasATrapezoidalSpeedProfile) {
  // At the start v^2 = v_0^2 + 2 a s, and at the end v^2 = 2 b (L - s), with the acceleration a,
  // the deceleration b and the length L. The mission's speed limits both.
  for (const double start_speed : {0.0, 4.0, 10.0}) {
    PlanRequest request = StraightRequest();
    request.start_speed = start_speed;
    const double length = 100.0;
    const Plan plan = PlanStraight(request, length);
    for (double s = 0.0; s <= length; s += 0.5) {
      const double speed = std::min({std::sqrt(start_speed * start_speed + 2.0 * 2.0 * s), 10.0,
                                     std::sqrt(2.0 * 4.0 * (length - s))});
      // Near v = 0, the square root turns a rounding error of 1e-14 in v^2 into an error of 1e-7 in
      // v.
      EXPECT_NEAR(plan.reference.speed.SpeedAt(s), speed, Tolerance(1e-6)) << s;
    }
  }
}

TEST(Straight, PeaksBelowTheMissionsSpeedIfItIsShort) {
  // The car starts to brake at s = L b/(a + b) = 2 m, where 2 a s = 2 b (L - s) = v^2 = 8 m^2/s^2.
  const Plan plan = PlanStraight(StraightRequest(), 3.0);
  EXPECT_NEAR(plan.reference.speed.SpeedAt(2.0), std::sqrt(8.0), Tolerance(1e-12));
  EXPECT_LT(plan.reference.speed.SpeedAt(1.9), std::sqrt(8.0));
  EXPECT_LT(plan.reference.speed.SpeedAt(2.1), std::sqrt(8.0));
  EXPECT_EQ(plan.reference.speed.SpeedAt(3.0), 0.0);
}

}  // namespace
}  // namespace trackbed
