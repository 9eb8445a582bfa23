#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/replan/detour.h"
#include "trackbed/planning/sampling/rrt_planner.h"
#include "trackbed/world/world.h"

// Tests partial RRT plans. A partial plan ends as near to the goal as the trees came within their
// samples or their time.
namespace trackbed {
namespace {

using ::testing::HasSubstr;

PlanRequest To(std::vector<Vec2> waypoints, std::vector<OrientedBox> obstacles = {}) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.waypoints = {{0.0, 0.0}};
  request.waypoints.insert(request.waypoints.end(), waypoints.begin(), waypoints.end());
  request.obstacles = std::move(obstacles);
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

/// Returns a request with a wall across the whole sampled area. The near side of the wall is at x =
/// 29.5 m.
PlanRequest BeforeAWall() {
  return To({{50.0, 0.0}}, {{{30.0, 0.0, 0.0}, 1.0, 200.0}});
}

Vec2 EndPoint(const Plan& plan) {
  return plan.reference.path.At(plan.reference.path.length()).pose.position();
}

/// Returns the index of the node that is nearest to a point, among the nodes from the index `first`
/// on.
std::size_t NearestNode(const std::vector<TreeNode>& tree, const Vec2& point,
                        std::size_t first = 0) {
  std::size_t nearest = first;
  for (std::size_t i = first; i < tree.size(); ++i) {
    if ((tree[i].position - point).norm() < (tree[nearest].position - point).norm()) {
      nearest = i;
    }
  }
  return nearest;
}

/// Returns the number of steps from `node` toward the root to the node at `point`; nullopt if no
/// such node is on the way.
std::optional<int> NodesBefore(const std::vector<TreeNode>& tree, std::size_t node,
                               const Vec2& point) {
  for (int before = 0;; ++before) {
    if ((tree[node].position - point).norm() < Tolerance(1e-9)) {
      return before;
    }
    if (tree[node].parent == node) {
      return std::nullopt;
    }
    node = tree[node].parent;
  }
}

/// Checks the exact distance between the footprint and the boxes every 2 cm. Within half a step,
/// the farthest corner moves by (1 + 3.7/5.1) x 1 cm = 1.7 cm.
void ExpectClear(const PlanRequest& request, const Plan& plan) {
  const Path& path = plan.reference.path;
  for (double s = 0.0; s < path.length() + 0.02; s += 0.02) {
    const OrientedBox footprint =
        FootprintAt(request.vehicle, path.At(std::min(s, path.length())).pose);
    for (const OrientedBox& box : request.obstacles) {
      ASSERT_GE(Separation(footprint, box), 0.3 - Tolerance(0.018)) << "at " << s;
    }
  }
}

TEST(PartialPlan, EndsAtTheNodeNearestToTheGoal) {
  int at_the_nearest = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    PlanRequest request = To({{60.0, 5.0}});
    request.seed = seed;
    const Plan plan =
        MakePlan(request, RrtPlannerOptions{.trees = 1, .iterations = 40, .partial = true});
    ASSERT_TRUE(plan.ok()) << plan.reason;
    if (plan.partial.empty()) {
      EXPECT_EQ(DiagnosticsJson(plan).count("partial"), 0U);
      continue;
    }
    const Vec2 goal = request.waypoints.back();
    const std::size_t nearest = NearestNode(plan.tree, goal);
    const auto before = NodesBefore(plan.tree, nearest, EndPoint(plan));
    ASSERT_TRUE(before) << seed;
    at_the_nearest += *before == 0 ? 1 : 0;
    EXPECT_NEAR(DiagnosticsJson(plan)["left_m"], (EndPoint(plan) - goal).norm(), Tolerance(1e-9));
    EXPECT_EQ(plan.reference.speed.SpeedAt(plan.reference.path.length()), 0.0);
  }
  // If a branch has a corner that is too sharp for the car, the plan ends before the nearest node.
  EXPECT_GE(at_the_nearest, 20);
}

TEST(PartialPlan, SaysHowFarItLeads) {
  const PlanRequest request = BeforeAWall();
  const Plan plan =
      MakePlan(request, RrtPlannerOptions{.trees = 3, .iterations = 500, .partial = true});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_THAT(plan.partial,
              HasSubstr("m from waypoint 1, the nearest feasible path of 3 trees of 500 samples"));
  EXPECT_TRUE(plan.blocked.empty());
  EXPECT_EQ(DiagnosticsJson(plan)["partial"], true);
  EXPECT_EQ(DiagnosticsJson(plan)["partial_reason"], plan.partial);
  EXPECT_EQ(DiagnosticsJson(plan)["next_waypoint"], 1);
  EXPECT_EQ(DiagnosticsJson(plan)["legs"].at(0)["status"], "iterations");
  // The mission's goal is unchanged.
  EXPECT_EQ(plan.goal, (Pose2{50.0, 0.0, 0.0}));
}

TEST(PartialPlan, KeepsClearOfWhatStoppedTheTree) {
  // Nodes come within 2.16 m of the wall. At such a node, the front of the car, 3.625 m ahead of
  // the rear axle, would be in the wall.
  PlanRequest request = BeforeAWall();
  for (request.seed = 0; request.seed < 10; ++request.seed) {
    const Plan plan =
        MakePlan(request, RrtPlannerOptions{.trees = 3, .iterations = 1000, .partial = true});
    ASSERT_TRUE(plan.ok()) << plan.reason;
    ExpectClear(request, plan);
    const std::size_t nearest = NearestNode(plan.tree, request.waypoints.back());
    EXPECT_TRUE(NodesBefore(plan.tree, nearest, EndPoint(plan)));
    EXPECT_LE(EndPoint(plan).x(), plan.tree[nearest].position.x());
    EXPECT_GT(EndPoint(plan).x(), 20.0);
  }
}

TEST(PartialPlan, IsOfTheTreeThatLeadsNearest) {
  double left = std::numeric_limits<double>::infinity();
  double of_one = 0.0;
  for (int trees = 1; trees <= 8; ++trees) {
    const Plan plan = MakePlan(
        BeforeAWall(), RrtPlannerOptions{.trees = trees, .iterations = 25, .partial = true});
    ASSERT_TRUE(plan.ok()) << plan.reason;
    const double own = DiagnosticsJson(plan)["left_m"];
    const auto each = DiagnosticsJson(plan)["trees"];
    ASSERT_EQ(each.size(), static_cast<std::size_t>(trees));
    for (const auto& tree : each) {
      EXPECT_LE(own, tree.value("left_m", own));
    }
    EXPECT_EQ(each.at(DiagnosticsJson(plan)["chosen"].get<std::size_t>())["left_m"], own);
    // A run with more trees begins with the same trees as a run with fewer trees.
    EXPECT_LE(own, left);
    left = own;
    of_one = trees == 1 ? own : of_one;
  }
  EXPECT_LT(left, of_one);
}

TEST(PartialPlan, LeadsThroughTheWaypointsThatAreReached) {
  PlanRequest request =
      To({{20.0, 8.0}, {50.0, 8.0}, {50.0, 30.0}}, {{{38.0, 0.0, 0.0}, 1.0, 200.0}});
  const Plan plan =
      MakePlan(request, RrtPlannerOptions{.trees = 4, .iterations = 2000, .partial = true});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_EQ(DiagnosticsJson(plan)["next_waypoint"], 2);
  EXPECT_THAT(plan.partial, HasSubstr("m from waypoint 2"));
  ExpectClear(request, plan);
  const auto legs = DiagnosticsJson(plan)["legs"];
  ASSERT_EQ(legs.size(), 2U);
  EXPECT_EQ(legs[0]["status"], "reached");
  const std::size_t nearest =
      NearestNode(plan.tree, request.waypoints[2], legs[0]["nodes"].get<std::size_t>());
  EXPECT_TRUE(NodesBefore(plan.tree, nearest, EndPoint(plan)));
  EXPECT_NEAR(DiagnosticsJson(plan)["left_m"], (EndPoint(plan) - request.waypoints[2]).norm(),
              Tolerance(1e-9));
  // The path rounds the corner at this node, and misses the node by no more than the turning radius
  // of the car implies.
  EXPECT_LT(
      (plan.reference.path.At(plan.reference.path.Project({20.0, 8.0, 0.0}).s).pose.position() -
       Vec2(20.0, 8.0))
          .norm(),
      3.0);
  EXPECT_EQ(plan.goal.position(), Vec2(50.0, 30.0));
}

TEST(PartialPlan, IsNotTakenUnlessAskedFor) {
  const RrtPlannerOptions options{.trees = 2, .iterations = 200};
  EXPECT_EQ(MakePlan(BeforeAWall(), options)->status, PlanStatus::kBudgetUsedUp);
  RrtPlannerOptions never = options;
  never.partial = false;
  never.time_limit = 1.0;
  EXPECT_FALSE(MayBePartial(never));
  EXPECT_EQ(MakePlan(BeforeAWall(), never)->status, PlanStatus::kBudgetUsedUp);
  RrtPlannerOptions limited = options;
  limited.time_limit = 1.0;
  EXPECT_TRUE(MayBePartial(limited));
  EXPECT_FALSE(MakePlan(BeforeAWall(), limited)->partial.empty());
}

TEST(PartialPlan, IsNoneWhereTheGoalIsReached) {
  const PlanRequest request = To({{50.0, 0.0}}, {{{25.0, 0.0, 0.0}, 6.0, 6.0}});
  const Plan plan = MakePlan(request, RrtPlannerOptions{.partial = true});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_EQ(plan.partial, "");
  EXPECT_EQ(plan.reference.path.segments(),
            MakePlan(request, RrtPlannerOptions{})->reference.path.segments());
}

TEST(PartialPlan, IsNoneTowardABlockedWaypoint) {
  const PlanRequest request = To({{50.0, 0.0}}, {{{50.0, 1.0, 0.0}, 2.0, 2.0}});
  EXPECT_EQ(MakePlan(request, RrtPlannerOptions{.partial = true})->status,
            PlanStatus::kGoalBlocked);
}

TEST(PartialPlan, IsNoneWhereTheCarWouldStayWhereItIs) {
  const Plan plan =
      MakePlan(BeforeAWall(),
               RrtPlannerOptions{.lead_in = 0.0, .trees = 2, .iterations = 0, .partial = true});
  EXPECT_EQ(plan.status, PlanStatus::kBudgetUsedUp);
  EXPECT_THAT(plan.reason, HasSubstr("ends 50 m from waypoint 1"));
}

TEST(PartialPlan, OfSamplesAloneIsTheSameEveryTime) {
  const RrtPlannerOptions options{.trees = 4, .iterations = 300, .partial = true};
  const Plan first = MakePlan(BeforeAWall(), options);
  const Plan second = MakePlan(BeforeAWall(), options);
  ASSERT_FALSE(first.partial.empty()) << first.reason;
  EXPECT_EQ(first.reference.path.segments(), second.reference.path.segments());
  EXPECT_EQ(first.partial, second.partial);
  EXPECT_EQ(DiagnosticsJson(first), DiagnosticsJson(second));
}

/// Returns a clock that advances by `step` [s] on every read.
std::function<double()> Clock(double step) {
  return [time = 0.0, step]() mutable { return time += step; };
}

TEST(TimeLimit, EndsTheTreeAndLeadsToItsNearestNode) {
  PlanRequest request = BeforeAWall();
  request.clock = Clock(1.0 / 1024.0);
  const Plan limited = MakePlan(request, RrtPlannerOptions{.time_limit = 64.0 / 1024.0});
  ASSERT_TRUE(limited.ok()) << limited.reason;
  EXPECT_THAT(limited.partial, HasSubstr("the nearest feasible path of 1 tree in 0.0625 s"));
  // The planner reads the clock at the start and before every iteration, and each reading advances
  // the test's clock. The time limit is reached before the 64th iteration.
  const auto leg = DiagnosticsJson(limited)["legs"].at(0);
  EXPECT_EQ(leg["status"], "stopped");
  EXPECT_EQ(leg["iterations"], 63);
  // A plan with the same number of samples and no clock must be equal.
  const Plan counted =
      MakePlan(request, RrtPlannerOptions{.trees = 1, .iterations = 63, .partial = true});
  EXPECT_EQ(limited.reference.path.segments(), counted.reference.path.segments());
}

TEST(TimeLimit, KeepsTheWayThatWasFoundBefore) {
  PlanRequest request = To({{50.0, 0.0}}, {{{25.0, 0.0, 0.0}, 6.0, 6.0}});
  const Plan one = MakePlan(request, RrtPlannerOptions{.trees = 1});
  ASSERT_TRUE(one.ok()) << one.reason;
  // The time is enough for the first tree, but not for the second tree.
  const double samples = DiagnosticsJson(one)["legs"].at(0)["iterations"];
  request.clock = Clock(1.0);
  const Plan limited = MakePlan(request, RrtPlannerOptions{.time_limit = samples + 2.0});
  ASSERT_TRUE(limited.ok()) << limited.reason;
  EXPECT_EQ(limited.partial, "");
  EXPECT_EQ(DiagnosticsJson(limited)["trees"].size(), 2U);
  EXPECT_EQ(DiagnosticsJson(limited)["chosen"], 0);
  EXPECT_EQ(limited.reference.path.segments(), one.reference.path.segments());
}

TEST(TimeLimit, WithoutPartialPlansIsAReasonToRefuse) {
  PlanRequest request = BeforeAWall();
  request.clock = Clock(0.01);
  const Plan plan = MakePlan(request, RrtPlannerOptions{.time_limit = 0.5, .partial = false});
  EXPECT_EQ(plan.status, PlanStatus::kBudgetUsedUp);
  EXPECT_THAT(plan.reason, HasSubstr("not reached by 1 tree in 0.5 s"));
}

TEST(TimeLimit, IsKeptByTheCallersClockAlone) {
  // A time limit below the time of any tree has no effect without a clock, or with a stopped clock.
  PlanRequest request = To({{50.0, 0.0}}, {{{25.0, 0.0, 0.0}, 6.0, 6.0}});
  const Plan without = MakePlan(request, RrtPlannerOptions{});
  const RrtPlannerOptions limited{.time_limit = 1e-9};
  EXPECT_EQ(MakePlan(request, limited)->reference.path.segments(),
            without.reference.path.segments());
  request.clock = Clock(0.0);
  EXPECT_EQ(MakePlan(request, limited)->reference.path.segments(),
            without.reference.path.segments());
}

TEST(PartialPlan, IsNoDetour) {
  const SpeedLimits speed{3.0, 1.0, 2.0};
  DetourRequest request{.vehicle = ReferenceCar(), .speed = speed};
  const Path path({0.0, 0.0, 0.0}, {{120.0, 0.0}});
  request.route.reference = {path, StopAtEnd(120.0, 3.0, speed)};
  request.route.schedule_speed = request.route.reference.speed;
  request.route.goal = {120.0, 0.0, 0.0};
  request.driven = request.route;
  request.station = 20.0;
  request.route_station = 20.0;
  request.station_speed = 3.0;
  // A wall across the whole sampled area.
  request.obstacles = {{{60.0, 0.0, 0.0}, 1.0, 200.0}};
  const Detour detour = PlanDetour(
      request, RrtPlannerOptions{.trees = 1, .iterations = 500, .partial = true}, {.attempts = 1});
  EXPECT_FALSE(detour.route);
  EXPECT_NE(detour.why, "");
}

}  // namespace
}  // namespace trackbed
