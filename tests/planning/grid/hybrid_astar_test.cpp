#include "trackbed/planning/grid/hybrid_astar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/planning/grid/hybrid_path_check.h"
#include "tests/planning/maps.h"
#include "tests/planning/poses.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/curves/reeds_shepp.h"

namespace trackbed {
namespace {

using ::testing::HasSubstr;

/// Returns a problem with a row of parked cars beside a lane. The goal is in the only gap of the
/// row.
HybridAStarProblem ParkingRow() {
  HybridAStarProblem problem{
      .start = {0.0, 0.0, 0.0}, .goal = {20.0, -6.2, 0.5 * kPi}, .obstacles = {}};
  for (const double x : {8.0, 11.0, 14.0, 17.0, 23.0, 26.0, 29.0}) {
    problem.obstacles.push_back({{x, -5.0, 0.5 * kPi}, 4.5, 1.8});
  }
  problem.obstacles.push_back({{18.0, 5.0, 0.0}, 50.0, 1.0});   // the other side of the lane
  problem.obstacles.push_back({{18.0, -9.0, 0.0}, 50.0, 1.0});  // behind the row
  return problem;
}

TEST(HybridAStar, IsTheShortestCurveWhereNothingIsInTheWay) {
  Random random(1);
  HybridAStarOptions options;
  options.reverse_cost = 1.0;
  options.switch_cost = 0.0;
  options.steering_cost = 0.0;
  for (int i = 0; i < 20; ++i) {
    const HybridAStarProblem problem{
        .start = RandomPose(random, 15.0), .goal = RandomPose(random, 15.0), .obstacles = {}};
    const HybridAStarResult result = SearchHybridAStar(ReferenceCar(), problem, options);
    ExpectGood(problem, options, result);
    EXPECT_NEAR(
        result.cost,
        ReedsSheppLength(problem.start, problem.goal, 1.1 * ReferenceCar().min_turning_radius()),
        Tolerance(1e-9));
    EXPECT_LE(result.expansions, 20);
  }
}

TEST(HybridAStar, ParksInAGapBackwards) {
  const HybridAStarProblem problem = ParkingRow();
  const HybridAStarOptions options;
  const HybridAStarResult result = SearchHybridAStar(ReferenceCar(), problem, options);
  ExpectGood(problem, options, result);
  // A car that faces the lane in its gap has entered the gap in reverse.
  EXPECT_EQ(result.segments.front().direction, 1);
  EXPECT_EQ(result.segments.back().direction, -1);
}

TEST(HybridAStar, FindsNoWayBackwardsWhereItMayNot) {
  HybridAStarOptions options;
  options.reverse = false;
  options.budget = 10000;
  const HybridAStarResult result = SearchHybridAStar(ReferenceCar(), ParkingRow(), options);
  EXPECT_FALSE(result.ok());
  EXPECT_NE(result.reason, "");
  EXPECT_TRUE(result.segments.empty());
}

TEST(HybridAStar, GoesThroughMaps) {
  for (const Map& map : Maps()) {
    if (map.name == "passage" || map.name == "clutter") {
      continue;  // only a point that turns on the spot can pass
    }
    SCOPED_TRACE(map.name);
    const HybridAStarProblem problem{.start = {map.problem.start.x(), map.problem.start.y(), 0.0},
                                     .goal = {map.problem.goal.x(), map.problem.goal.y(), 0.0},
                                     .obstacles = map.problem.obstacles};
    for (const bool reverse : {true, false}) {
      if (!reverse && map.name != "open_field") {
        continue;  // too narrow to turn around without reversing
      }
      HybridAStarOptions options;
      options.reverse = reverse;
      options.safe_distance = 0.1;
      options.radius = 5.2;
      const HybridAStarResult result = SearchHybridAStar(ReferenceCar(), problem, options);
      ExpectGood(problem, options, result);
      for (const Segment& segment : result.segments) {
        EXPECT_TRUE(reverse || segment.direction > 0);
      }
    }
  }
}

TEST(HybridAStar, IsNoCheaperThanWhatIsLeftSays) {
  // The heuristic, the length of the shortest curve without obstacles, must not exceed the cost
  // found.
  const HybridAStarProblem problem = ParkingRow();
  const HybridAStarResult result = SearchHybridAStar(ReferenceCar(), problem, {});
  ASSERT_TRUE(result.ok());
  EXPECT_GE(result.cost, ReedsSheppLength(problem.start, problem.goal,
                                          1.1 * ReferenceCar().min_turning_radius()));
}

TEST(HybridAStar, EndsWithAStatus) {
  const HybridAStarProblem free{.start = {}, .goal = {20.0, 5.0, 1.0}, .obstacles = {}};
  const auto status = [](HybridAStarProblem problem, const OrientedBox& box, int budget) {
    problem.obstacles.push_back(box);
    HybridAStarOptions options;
    options.budget = budget;
    const HybridAStarResult result = SearchHybridAStar(ReferenceCar(), problem, options);
    EXPECT_EQ(result.reason.empty(), result.ok());
    EXPECT_LE(result.expansions, budget);
    return result.status;
  };
  const OrientedBox away{{0.0, 30.0, 0.0}, 1.0, 1.0};
  EXPECT_EQ(status(free, away, 1000), PlanStatus::kOk);
  EXPECT_EQ(status(free, away, 0), PlanStatus::kBudgetUsedUp);
  EXPECT_EQ(status(free, {{1.0, 0.0, 0.0}, 1.0, 1.0}, 1000), PlanStatus::kStartBlocked);
  EXPECT_EQ(status(free, {{20.0, 6.0, 0.0}, 1.0, 1.0}, 1000), PlanStatus::kGoalBlocked);
  // Walls surround the goal. The grid search detects this before the planner checks any pose.
  HybridAStarProblem walled = free;
  for (const auto& [x, y, length, width] :
       {std::tuple{20.0, -3.0, 24.0, 1.0}, {20.0, 17.0, 24.0, 1.0}, {9.0, 7.0, 1.0, 20.0}}) {
    walled.obstacles.push_back({{x, y, 0.0}, length, width});
  }
  EXPECT_EQ(status(walled, {{31.5, 7.0, 0.0}, 1.0, 20.0}, 1000), PlanStatus::kNoPath);
}

TEST(HybridAStar, RefusesOptionsThatAreNone) {
  HybridAStarOptions options;
  options.cell = 0.0;
  EXPECT_THROW(SearchHybridAStar(ReferenceCar(), {.start = {}, .goal = {5.0, 0.0, 0.0}}, options),
               InternalError);
}

}  // namespace
}  // namespace trackbed
