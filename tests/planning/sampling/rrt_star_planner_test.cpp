#include "trackbed/planning/sampling/rrt_star_planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/registry/planners.h"

// Tests specific to the RRT* planner. The file rrt_star_test.cpp tests the trees, and
// route_planners_test.cpp tests the guarantees of every planner.
namespace trackbed {
namespace {

using ::testing::HasSubstr;

/// Returns a request with a wall that ends 5 m to the left of the line to the goal and extends far
/// to the right.
PlanRequest AroundAWall() {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.waypoints = {{0.0, 0.0}, {60.0, 0.0}};
  request.obstacles = {{{30.0, -45.0, 0.0}, 0.0, 100.0}};
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

/// Returns the length of the shortest path of a point around the inflated end of the wall. The path
/// starts at the end of the lead-in, x = `lead`. The path consists of two tangents to the circle
/// around the wall's end, and the arc between them.
double ShortestAround(double lead, double inflation) {
  const double from = std::hypot(30.0 - lead, 5.0);
  const double to = std::hypot(30.0, 5.0);
  const double turn = std::acos(inflation / from) + std::acos(inflation / to);
  // The directions from the wall's end, which is 5 m to the left of the line, to the two ends of
  // the path form this angle.
  const double between = std::atan2(30.0 - lead, 5.0) + std::atan2(30.0, 5.0);
  return std::sqrt(from * from - inflation * inflation) +
         std::sqrt(to * to - inflation * inflation) + inflation * (2.0 * M_PI - between - turn);
}

/// Returns the length of the tree's path, even if the car cannot follow this path.
double TreeLength(const Plan& plan) {
  const nlohmann::json own = DiagnosticsJson(plan);
  double length = 0.0;
  for (const auto& leg : own["legs"]) {
    length += leg.at("cost_m").get<double>();
  }
  return length;
}

TEST(RrtStarPlanner, DrivesRoundTheEndsOfThinWalls) {
  // A shortest path has many short edges around the end of a wall.
  for (const double end : {-5.0, 0.0, 2.5, 5.0, 10.0, 20.0}) {
    for (const double start_speed : {0.0, 3.0}) {
      PlanRequest request = AroundAWall();
      request.obstacles = {{{30.0, end - 50.0, 0.0}, 0.3, 100.0}};
      request.start_speed = start_speed;
      const Plan plan = MakePlan(request, RrtStarPlannerOptions{});
      EXPECT_TRUE(plan.ok()) << "end " << end << ", " << start_speed << " m/s: " << plan.reason;
    }
  }
}

TEST(RrtStarPlanner, MoreSamplesNeverLengthenTheTreesPathAndComeNearTheShortest) {
  PlanRequest request = AroundAWall();
  const RrtStarPlannerOptions defaults;
  const double inflation =
      0.5 * ReferenceCar().width + defaults.safe_distance + defaults.corner_room;
  const double shortest = ShortestAround(defaults.lead_in, inflation);
  for (request.seed = 1; request.seed <= 4; ++request.seed) {
    double before = std::numeric_limits<double>::infinity();
    for (const int iterations : {1000, 3000, 10000}) {
      const Plan plan =
          MakePlan(request, RrtStarPlannerOptions{.trees = 1, .iterations = iterations});
      const double length = TreeLength(plan);
      EXPECT_LE(length, before);
      EXPECT_GE(length, shortest - Tolerance(1e-9));
      before = length;
    }
    // On other maps, 20000 samples come within 3 % of the shortest path (rrt_star_test.cpp).
    EXPECT_LE(before, shortest * (1.0 + Tolerance(0.03)));
  }
}

TEST(RrtStarPlanner, GivesItsTreeAndSaysHowEachOfThemEnded) {
  PlanRequest request = AroundAWall();
  request.start = {2.0, 1.0, 0.3};
  request.waypoints = {{2.0, 1.0}, {60.0, 0.0}, {90.0, 20.0}};
  const Plan plan = MakePlan(request, RrtStarPlannerOptions{});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const auto own = DiagnosticsJson(plan);
  ASSERT_EQ(own["legs"].size(), 2U);
  EXPECT_EQ(own["trees"].back()["status"], "ok");
  ASSERT_EQ(plan.tree.size(), own["legs"][0]["nodes"].get<std::size_t>() +
                                  own["legs"][1]["nodes"].get<std::size_t>());
  for (std::size_t i = 0; i < plan.tree.size(); ++i) {
    const TreeNode& node = plan.tree[i];
    const TreeNode& parent = plan.tree.at(node.parent);
    // The tolerance allows for rounding in sums of some tens of lengths up to 100 m.
    EXPECT_NEAR(node.cost, parent.cost + (node.position - parent.position).norm(),
                Tolerance(1e-11));
  }
}

TEST(RrtStarPlanner, NeedsNoTreeWhereTheStraightLineIsFree) {
  PlanRequest request = AroundAWall();
  request.waypoints = {{0.0, 0.0}, {12.0, 0.0}, {60.0, 0.0}, {80.0, 0.0}};
  const Plan plan = MakePlan(request, RrtStarPlannerOptions{});
  const auto own = DiagnosticsJson(plan);
  ASSERT_EQ(own["legs"].size(), 3U) << plan.reason;
  // The first leg begins after the lead-in of 4 m.
  EXPECT_NEAR(own["legs"][0]["cost_m"].get<double>(), 8.0, Tolerance(1e-12));
  EXPECT_NEAR(own["legs"][2]["cost_m"].get<double>(), 20.0, Tolerance(1e-12));
  for (const std::size_t free : {0U, 2U}) {
    EXPECT_EQ(own["legs"][free]["status"], "found");
    EXPECT_EQ(own["legs"][free]["iterations"], 0);
    EXPECT_EQ(own["legs"][free]["nodes"], 2);
  }
  EXPECT_EQ(own["legs"][1]["iterations"], RrtStarPlannerOptions{}.iterations);
}

TEST(RrtStarPlanner, SaysHowNearItCame) {
  PlanRequest request = AroundAWall();
  // The sampled area does not reach beyond the ends of the wall.
  request.obstacles = {{{30.0, 0.0, 0.0}, 1.0, 200.0}};
  const Plan plan =
      MakePlan(request, RrtStarPlannerOptions{.margin = 1.0, .trees = 2, .iterations = 300});
  EXPECT_EQ(plan.status, PlanStatus::kBudgetUsedUp);
  EXPECT_THAT(plan.reason, HasSubstr("waypoint 1 not reached by 300 samples: the nearest node is"));
  EXPECT_EQ(DiagnosticsJson(plan)["trees"].size(), 2U);
  EXPECT_TRUE(plan.tree.empty());
}

TEST(RrtStarPlanner, NamesTheWaypointThatIsBlocked) {
  PlanRequest request = AroundAWall();
  request.obstacles.push_back({{61.0, 0.0, 0.0}, 1.0, 1.0});
  const Plan plan = MakePlan(request, RrtStarPlannerOptions{});
  EXPECT_EQ(plan.status, PlanStatus::kGoalBlocked);
  EXPECT_THAT(plan.reason, HasSubstr("waypoint 1 is blocked: the obstacle at (61, 0)"));
  EXPECT_EQ(DiagnosticsJson(plan)["trees"].size(), 1U);
}

TEST(RrtStarPlanner, BeginsStraightOn) {
  PlanRequest request = AroundAWall();
  request.start.yaw = 0.4;
  const Plan plan = MakePlan(request, RrtStarPlannerOptions{});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_NEAR(plan.reference.path.At(0.0).pose.yaw, 0.4, Tolerance(1e-9));
}

TEST(RrtStarPlanner, DrawsNoMoreSamplesThanTheRequestAllows) {
  PlanRequest request = AroundAWall();
  const RrtStarPlannerOptions options{.trees = 50, .iterations = 4000};
  request.max_samples = 10;
  const Plan refused = MakePlan(request, options);
  EXPECT_EQ(refused.status, PlanStatus::kBudgetUsedUp);
  EXPECT_EQ(refused.diagnostics.samples, 10);
  EXPECT_NE(refused.reason.find("not reached by 10 samples, the last of those allowed"),
            std::string::npos)
      << refused.reason;
  request.max_samples = 3000;
  const Plan plan = MakePlan(request, options);
  EXPECT_LE(plan.diagnostics.samples, 3000);
}

}  // namespace
}  // namespace trackbed
