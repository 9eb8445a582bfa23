#include "src/drive/termination.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/drive/unicycle.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace termination_test {

/// A vehicle of 4 m length, which has arrived if it is within 0.4 m of the goal at (10, 0).
LoopConfig Config() {
  return {.vehicle = UnicycleParams()};
}

class TerminationTest : public ::testing::Test {
 protected:
  TerminationTest() {
    state_.pose = {10.0, 0.0, 0.0};
    state_.time = 5.0;
  }

  std::optional<DriveStatus> Ask(Termination& termination) {
    return termination.Update({.state = state_,
                               .plant = plant_,
                               .segment = plan_,
                               .is_last_segment = is_last_segment_,
                               .interrupted = interrupted_,
                               .at_rest = at_rest_,
                               .to_move = to_move_,
                               .run_continues = run_continues_,
                               .contact_time = contact_time_});
  }

  std::optional<DriveStatus> Ask() {
    Termination termination(config_, plan_);
    return Ask(termination);
  }

  LoopConfig config_ = Config();
  Plan plan_ = PlanAlongRoute({{.length = 10.0}}, 0.0);
  VehicleState state_;
  bool is_last_segment_ = true;
  Unicycle plant_{StartState{}};
  bool to_move_ = false;
  bool interrupted_ = false;
  bool at_rest_ = true;
  bool run_continues_ = false;
  std::optional<double> contact_time_;
};

TEST(IsAtRest, IsSlowAndNotAskedToMove) {
  VehicleState state;
  Command command;
  EXPECT_TRUE(IsAtRest(state, command));
  state.speed = 0.0101;
  EXPECT_FALSE(IsAtRest(state, command));
  state.speed = -0.0101;
  EXPECT_FALSE(IsAtRest(state, command));
  state.speed = -0.0099;
  for (const int gear : {1, -1}) {
    command.gear = gear;
    command.acceleration = 0.1 * gear;  // the speed is in the direction of the gear, so the car is
                                        // about to start
    EXPECT_FALSE(IsAtRest(state, command)) << gear;
    command.acceleration = -0.1 * gear;
    EXPECT_TRUE(IsAtRest(state, command)) << gear;
  }
}

TEST_F(TerminationTest, ArrivesAtRestNearTheGoal) {
  EXPECT_EQ(Ask(), DriveStatus::kArrived);
  state_.pose.x = 9.61;
  EXPECT_EQ(Ask(), DriveStatus::kArrived);
  state_.pose.x = 9.59;
  EXPECT_EQ(Ask(), DriveStatus::kStopped);
  state_.pose = {10.0, -0.41, 0.0};
  EXPECT_EQ(Ask(), DriveStatus::kStopped);
}

TEST_F(TerminationTest, GoesOnWhileTheCarMovesOrIsToMove) {
  at_rest_ = false;
  EXPECT_EQ(Ask(), std::nullopt);
  at_rest_ = true;
  run_continues_ = true;
  EXPECT_EQ(Ask(), std::nullopt);
}

TEST_F(TerminationTest, AsksForTheHeadingWhereItMatters) {
  state_.pose.yaw = 1.0;
  EXPECT_EQ(Ask(), DriveStatus::kArrived);
  config_.goal_heading_tolerance = 0.2;
  EXPECT_EQ(Ask(), DriveStatus::kStopped);
  for (const double turns : {0.0, 1.0, -2.0}) {
    for (const double side : {1.0, -1.0}) {
      state_.pose.yaw = 2.0 * std::numbers::pi * turns + side * 0.19;
      EXPECT_EQ(Ask(), DriveStatus::kArrived) << state_.pose.yaw;
      state_.pose.yaw = 2.0 * std::numbers::pi * turns + side * 0.21;
      EXPECT_EQ(Ask(), DriveStatus::kStopped) << state_.pose.yaw;
    }
  }
}

TEST_F(TerminationTest, SaysByHowMuchTheGoalIsMissed) {
  config_.goal_heading_tolerance = 0.2;
  const auto cause = [&] {
    Termination termination(config_, plan_);
    Ask(termination);
    return termination.cause();
  };
  EXPECT_EQ(cause(), "");
  state_.pose.yaw = -0.28;
  EXPECT_EQ(cause(), "heading error -0.28 rad exceeds 0.2 rad");
  state_.pose.x = 9.0;
  EXPECT_EQ(cause(), "distance of 1 m to the goal exceeds 0.4 m");
  is_last_segment_ = false;  // the goal is not in this segment
  EXPECT_EQ(cause(), "");
}

TEST_F(TerminationTest, DoesNotArriveBeforeTheLastSegment) {
  is_last_segment_ = false;
  EXPECT_EQ(Ask(), DriveStatus::kStopped);
}

TEST_F(TerminationTest, TellsBlockedAndPartialPlans) {
  plan_.partial = "ends 3 m from waypoint 1";
  EXPECT_EQ(Ask(), DriveStatus::kPartial);
  state_.pose.x = 5.0;  // at rest before the end of the partial path
  EXPECT_EQ(Ask(), DriveStatus::kStopped);
  plan_.blocked = "stops before the obstacle";
  EXPECT_EQ(Ask(), DriveStatus::kBlocked);
}

TEST_F(TerminationTest, EndsAtTheTimeLimitToHalfATimestep) {
  at_rest_ = false;
  config_.time_limit = 8.0;
  state_.time = 7.998;
  EXPECT_EQ(Ask(), std::nullopt);
  state_.time = 7.9991;
  EXPECT_EQ(Ask(), DriveStatus::kTimeLimit);
  config_.duration = 6.0;  // with a path, the end of the duration is not an arrival
  state_.time = 6.0;
  EXPECT_EQ(Ask(), DriveStatus::kTimeLimit);
}

TEST_F(TerminationTest, ArrivesAfterTheDurationWithoutAPath) {
  plan_ = PlanAtSpeed(3.0);
  config_.duration = 6.0;
  EXPECT_EQ(Ask(), std::nullopt);  // at rest, but before the end of the duration
  state_.time = 6.0;
  EXPECT_EQ(Ask(), DriveStatus::kArrived);
  config_.time_limit = 5.5;
  EXPECT_EQ(Ask(), DriveStatus::kStopped);
  at_rest_ = false;
  EXPECT_EQ(Ask(), DriveStatus::kTimeLimit);
}

TEST_F(TerminationTest, FollowsACollisionForASecond) {
  at_rest_ = false;
  Termination termination(config_, plan_);
  EXPECT_EQ(Ask(termination), std::nullopt);
  EXPECT_EQ(termination.end_time(), 600.0);
  contact_time_ = 4.5;
  EXPECT_EQ(Ask(termination), std::nullopt);
  EXPECT_EQ(termination.end_time(), 5.5);
  state_.time = 5.5;
  EXPECT_EQ(Ask(termination), DriveStatus::kCollided);
}

TEST_F(TerminationTest, IsACollisionEvenAtRestAtTheGoal) {
  contact_time_ = 4.5;
  EXPECT_EQ(Ask(), DriveStatus::kCollided);
}

TEST_F(TerminationTest, EndsRolledOverBeyondSixtyDegrees) {
  at_rest_ = false;
  constexpr double kDegree = std::numbers::pi / 180.0;
  for (const double side : {1.0, -1.0}) {
    state_.roll = side * 59.0 * kDegree;
    EXPECT_EQ(Ask(), std::nullopt);
    state_.roll = side * 61.0 * kDegree;
    EXPECT_EQ(Ask(), DriveStatus::kRolledOver);
    state_.roll = 0.0;
    state_.pitch = side * 61.0 * kDegree;
    EXPECT_EQ(Ask(), DriveStatus::kRolledOver);
    state_.pitch = 0.0;
  }
  state_.roll = state_.pitch = 46.0 * kDegree;  // cos^2(46 deg) = 0.483
  EXPECT_EQ(Ask(), DriveStatus::kRolledOver);
}

TEST_F(TerminationTest, IsSunkWhereAHubIsBelowTheRoad) {
  at_rest_ = false;
  config_.vehicle.wheel_radius = 0.3;
  plant_.gap = -0.299;
  EXPECT_EQ(Ask(), std::nullopt);
  plant_.gap = -0.301;
  EXPECT_EQ(Ask(), DriveStatus::kSunk);
}

TEST_F(TerminationTest, IsAirborneAfterASecondWithoutTheRoad) {
  at_rest_ = false;
  config_.vehicle.wheel_radius = 0.3;
  Termination termination(config_, plan_);
  const auto ask = [&](double time, double gap) {
    state_.time = time;
    plant_.gap = gap;
    return Ask(termination);
  };
  EXPECT_EQ(ask(5.0, 0.31), std::nullopt);
  EXPECT_EQ(ask(5.99, 0.31), std::nullopt);
  EXPECT_EQ(ask(6.0, 0.29), std::nullopt);  // a wheel is near the road again
  EXPECT_EQ(ask(6.01, 5.0), std::nullopt);
  EXPECT_EQ(ask(7.0, 9.0), std::nullopt);
  EXPECT_EQ(ask(7.02, 12.5), DriveStatus::kAirborne);
  EXPECT_EQ(termination.cause(), "all wheels are 12.5 m or more above the road");
}

TEST_F(TerminationTest, IsStuckAfterTenSecondsInPlaceAlthoughItIsToMove) {
  at_rest_ = false;
  to_move_ = true;
  Termination termination(config_, plan_);
  const auto ask = [&](double time, double x) {
    state_.time = time;
    state_.pose.x = x;
    return Ask(termination);
  };
  EXPECT_EQ(ask(1.0, 0.0), std::nullopt);
  EXPECT_EQ(ask(10.9, 0.009), std::nullopt);
  EXPECT_EQ(ask(11.0, 0.011), std::nullopt);  // the car moves slowly
  EXPECT_EQ(ask(20.9, 0.011), std::nullopt);
  to_move_ = false;
  EXPECT_EQ(ask(21.1, 0.011), std::nullopt);
  to_move_ = true;
  EXPECT_EQ(ask(21.2, 0.011), std::nullopt);
  EXPECT_EQ(ask(31.3, 0.011), DriveStatus::kStuck);
  EXPECT_EQ(termination.cause(), "has not moved since 21.20 s, although it was to drive");
}

TEST_F(TerminationTest, TellsTheWorstFirst) {
  plan_.blocked = "stops before the obstacle";
  EXPECT_EQ(Ask(), DriveStatus::kBlocked);
  contact_time_ = 4.5;
  EXPECT_EQ(Ask(), DriveStatus::kCollided);
  interrupted_ = true;
  EXPECT_EQ(Ask(), DriveStatus::kInterrupted);
  state_.roll = 3.0;
  EXPECT_EQ(Ask(), DriveStatus::kRolledOver);
  plant_.is_diverged = true;
  EXPECT_EQ(Ask(), DriveStatus::kDiverged);
}

}  // namespace termination_test
}  // namespace trackbed
