#include "trackbed/planning/common/plan_stretch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

/// Returns a plan along a straight of 100 m that begins and ends at rest. The speed is 20 m/s at 20
/// m and 80 m, and 15 m/s at 50 m.
Plan AtTheLimit() {
  Plan plan;
  plan.reference = {
      Path({}, {{100.0, 0.0, 1}}),
      SpeedProfile({{0.0, 0.0}, {20.0, 20.0}, {50.0, 15.0}, {80.0, 20.0}, {100.0, 0.0}})};
  plan.schedule = SteeringSchedule::Constant(0.0);
  plan.schedule_speed = plan.reference.speed;
  plan.diagnostics.speed_profile = LimitProfileFindings{.share = 0.9};
  plan.laps.lines = {0.0, 90.0};
  return plan;
}

TEST(RemainingPlans, KeepSpeedsAtTheLimit) {
  const Plan plan = AtTheLimit();
  const Plan rest = RemainingPlan(plan, 30.0, 19.0, {40.0, 1.0, 1.0});
  EXPECT_DOUBLE_EQ(rest.reference.path.length(), 70.0);
  for (double s = 0.0; s <= 70.0; s += 1.0) {
    EXPECT_NEAR(rest.reference.speed.SpeedAt(s), plan.reference.speed.SpeedAt(30.0 + s),
                Tolerance(1e-12));
    EXPECT_NEAR(rest.schedule_speed.SpeedAt(s), plan.reference.speed.SpeedAt(30.0 + s),
                Tolerance(1e-12));
  }
  EXPECT_EQ(rest.laps.lines, (std::vector<double>{-30.0, 60.0}));
}

TEST(RemainingPlans, GainSpeedUpToTheLimits) {
  // The car accelerates at 2 m/s^2, so v^2 = 5^2 + 2 x 2 s. The car is slower than the plan until
  // it brakes for the stop at the end of the plan.
  const Plan rest = RemainingPlan(AtTheLimit(), 30.0, 5.0, {40.0, 2.0, 1.0});
  for (const double s : {0.0, 10.0, 20.0, 35.0, 50.0}) {
    EXPECT_NEAR(rest.reference.speed.SpeedAt(s), std::sqrt(25.0 + 4.0 * s), Tolerance(1e-12));
  }
  EXPECT_DOUBLE_EQ(rest.reference.speed.SpeedAt(70.0), 0.0);
}

TEST(RemainingPlans, FollowTheLimitsOfOtherPlans) {
  Plan plan = AtTheLimit();
  plan.diagnostics.speed_profile.reset();
  plan.caps = {{60.0, 100.0, 10.0}};
  const Plan rest = RemainingPlan(plan, 30.0, 12.0, {12.0, 1.0, 2.0});
  EXPECT_DOUBLE_EQ(rest.reference.speed.SpeedAt(0.0), 12.0);
  EXPECT_NEAR(rest.reference.speed.SpeedAt(30.0), 10.0, Tolerance(1e-12));
}

TEST(Caps, OfAPlanAtTheLimitAreItsSpeeds) {
  Plan plan = AtTheLimit();
  const std::vector<SpeedCap> caps = CapsOf(plan);
  ASSERT_EQ(caps.size(), 4U);
  // The start speed of the plan, 0 m/s, does not cap the speed.
  EXPECT_DOUBLE_EQ(caps[0].speed, 20.0);
  EXPECT_DOUBLE_EQ(caps[1].from, 20.0);
  EXPECT_DOUBLE_EQ(caps[1].to, 50.0);
  plan.diagnostics.speed_profile.reset();
  plan.caps = {{1.0, 2.0, 3.0}};
  EXPECT_EQ(CapsOf(plan).size(), 1U);
}

}  // namespace
}  // namespace trackbed
