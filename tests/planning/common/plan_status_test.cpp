#include "trackbed/planning/common/plan_status.h"

#include <gtest/gtest.h>

namespace trackbed {
namespace {

TEST(PlanStatus, HasTheSpellingsOfPlanJson) {
  EXPECT_STREQ(ToString(PlanStatus::kOk), "ok");
  EXPECT_STREQ(ToString(PlanStatus::kTooFewWaypoints), "too_few_waypoints");
  EXPECT_STREQ(ToString(PlanStatus::kDuplicateWaypoints), "duplicate_waypoints");
  EXPECT_STREQ(ToString(PlanStatus::kUTurn), "u_turn");
  EXPECT_STREQ(ToString(PlanStatus::kTurnTooTight), "turn_too_tight");
  EXPECT_STREQ(ToString(PlanStatus::kNoRoomForSteering), "no_room_for_steering");
  EXPECT_STREQ(ToString(PlanStatus::kTurnsOverlap), "turns_overlap");
  EXPECT_STREQ(ToString(PlanStatus::kSteersBeforeStart), "steers_before_start");
  EXPECT_STREQ(ToString(PlanStatus::kStartBlocked), "start_blocked");
  EXPECT_STREQ(ToString(PlanStatus::kGoalBlocked), "goal_blocked");
  EXPECT_STREQ(ToString(PlanStatus::kNoPath), "no_path");
  EXPECT_STREQ(ToString(PlanStatus::kBudgetUsedUp), "budget_used_up");
  EXPECT_STREQ(ToString(PlanStatus::kCollides), "collides");
  EXPECT_STREQ(ToString(PlanStatus::kWaypointMissed), "waypoint_missed");
}

}  // namespace
}  // namespace trackbed
