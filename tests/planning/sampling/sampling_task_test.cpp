#include "src/planning/sampling/sampling_task.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/vehicle/reference_car.h"

namespace trackbed {
namespace {

/// The planner options that PlanWithLeadIn uses.
struct Options {
  Corners corners = Corners::kRound;
  double safe_distance = 0.0;
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
  const auto refuse = [&](const Options& options, const PlanRequest&,
                          const std::vector<Vec2>& departure) {
    if (departure.empty()) {
      asked.push_back({options.lead_in, options.trees});
    }
    TreesPlan found;
    found.plan.status = status;
    return found;
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
}

TEST(PlanWithLeadIn, TriesAShorterStartOfACarAtRest) {
  PlanRequest standing = Rolling(100.0);
  standing.start_speed = 0.0;
  const double radius = ReferenceCar().min_turning_radius();
  EXPECT_EQ(AskedWhenRefused(standing, PlanStatus::kTurnTooTight),
            (std::vector<Asked>{{4.0, 3},
                                {4.0 + radius, 3},
                                {4.0 + 0.5 * radius, 1},
                                {4.0 + 0.25 * radius, 1},
                                {2.0, 1}}));
}

TEST(PlanWithLeadIn, LeavesACarThatHeadsElsewhereByATurn) {
  PlanRequest standing = Rolling(-100.0);  // the waypoint is behind the car
  standing.start_speed = 0.0;
  std::vector<std::vector<Vec2>> departures;
  const auto accept_turns = [&](const Options&, const PlanRequest&,
                                const std::vector<Vec2>& departure) {
    departures.push_back(departure);
    TreesPlan found;
    found.plan.status = departure.size() > 2 ? PlanStatus::kOk : PlanStatus::kUTurn;
    return found;
  };
  EXPECT_TRUE(PlanWithLeadIn(Options{}, standing, accept_turns, kLeadIns).ok());
  EXPECT_TRUE(departures.front().empty());
  EXPECT_EQ(departures.back().size(), 3U);
  // A waypoint far ahead needs no turn.
  standing.waypoints[1].x() = 100.0;
  departures.clear();
  EXPECT_FALSE(PlanWithLeadIn(Options{}, standing, accept_turns, kLeadIns).ok());
  EXPECT_THAT(departures, testing::Each(testing::IsEmpty()));
}

TEST(PlanWithLeadIn, NamesTheStartSpeedThatFits) {
  // With twice the deceleration of 1.5 m/s^2, a car can stop within 1 m from sqrt(2 x 3 x 1) m/s =
  // 2.45 m/s.
  const PlanRequest request = Rolling(1.0);
  const auto too_short = [&](const Options&, const PlanRequest&, const std::vector<Vec2>&) {
    Plan plan;
    plan.reference.path = Path({}, {{.length = 1.0}});
    SetSpeeds(plan, request.start_speed, request.speed);
    return TreesPlan{MakeFeasible(plan, request), plan};
  };
  const Plan plan = PlanWithLeadIn(Options{}, request, too_short, kLeadIns);
  EXPECT_EQ(plan.status, PlanStatus::kInfeasible);
  EXPECT_THAT(plan.reason, testing::HasSubstr("set mission.start.speed to at most 2.4"));
}

TEST(StraightStart, EndsHalfWayToTheFirstWaypointAtMost) {
  PlanRequest request = Rolling(10.0);
  EXPECT_EQ(StraightStart(4.0, request), 4.0);
  EXPECT_EQ(StraightStart(7.0, request), 5.0);
}

}  // namespace
}  // namespace trackbed
