#include "src/planning/sampling/sampling_task.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/vehicle/reference_car.h"

namespace trackbed {
namespace {

/// The planner options that PlanWithLeadIn uses.
struct Options {
  Corners corners = Corners::kRound;
  double lead_in = 4.0;
  int trees = 3;
};

struct Asked {
  double lead_in;
  int trees;
  bool operator==(const Asked&) const = default;
};

/// Returns a request for a car that rolls at 3 m/s and can stop within 3 m. The longest lead-in
/// exceeds the default lead-in by this distance and the smallest turning radius.
PlanRequest Rolling(double first_leg) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.waypoints = {{0.0, 0.0}, {first_leg, 0.0}};
  request.start_speed = 3.0;
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

double Longer() {
  return 0.5 * 3.0 * 3.0 / 1.5 + ReferenceCar().min_turning_radius();
}

std::vector<Asked> AskedWhenRefused(const PlanRequest& request, PlanStatus status) {
  std::vector<Asked> asked;
  const auto refuse = [&](const Options& options, const PlanRequest&) {
    asked.push_back({options.lead_in, options.trees});
    Plan plan;
    plan.status = status;
    return plan;
  };
  EXPECT_EQ(PlanWithLeadIn(Options{}, request, refuse, kLeadIns).status, status);
  return asked;
}

TEST(PlanWithLeadIn, TriesTheLongestThenAHalfAndAQuarterOfItWithOneTree) {
  const std::vector<Asked> expected{
      {4.0, 3}, {4.0 + Longer(), 3}, {4.0 + 0.5 * Longer(), 1}, {4.0 + 0.25 * Longer(), 1}};
  EXPECT_EQ(AskedWhenRefused(Rolling(100.0), PlanStatus::kTurnTooTight), expected);
}

TEST(PlanWithLeadIn, TriesNoStraightStartTwice) {
  // A longer lead-in is limited to half of the distance to the waypoint. For the second request,
  // this limit does not exceed the default lead-in, so no longer lead-in is possible.
  EXPECT_EQ(AskedWhenRefused(Rolling(10.0), PlanStatus::kTurnTooTight),
            (std::vector<Asked>{{4.0, 3}, {4.0 + Longer(), 3}}));
  EXPECT_EQ(AskedWhenRefused(Rolling(8.0), PlanStatus::kTurnTooTight),
            (std::vector<Asked>{{4.0, 3}}));
}

TEST(PlanWithLeadIn, TriesNoOtherWhereALongerOneDoesNotHelp) {
  EXPECT_EQ(AskedWhenRefused(Rolling(100.0), PlanStatus::kGoalBlocked).size(), 1U);
  PlanRequest standing = Rolling(100.0);
  standing.start_speed = 0.0;
  EXPECT_EQ(AskedWhenRefused(standing, PlanStatus::kTurnTooTight).size(), 1U);
}

TEST(StraightStart, EndsHalfWayToTheFirstWaypointAtMost) {
  PlanRequest request = Rolling(10.0);
  EXPECT_EQ(StraightStart(4.0, request), 4.0);
  EXPECT_EQ(StraightStart(7.0, request), 5.0);
}

}  // namespace
}  // namespace trackbed
