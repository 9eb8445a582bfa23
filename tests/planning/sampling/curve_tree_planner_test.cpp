#include "src/planning/sampling/curve_tree_planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/planning/poses.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/common/driving_time.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/world/world.h"

// Tests the trees of curves of `rrt_star` (edges: curves).
namespace trackbed {
namespace curve_tree_planner_test {

using ::testing::HasSubstr;

const RrtStarPlannerOptions kCurves{.edges = TreeEdges::kCurves};

/// Returns a request with a wall on the line to the first of two goals.
PlanRequest AroundAWall() {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.waypoints = {{0.0, 0.0}, {60.0, 0.0}, {90.0, 20.0}};
  request.obstacles = {{{30.0, -15.0, 0.0}, 1.0, 40.0}};
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

/// Returns the largest jump of the curvature between two segments of the path [1/m].
double LargestJump(const Path& path) {
  double jump = 0.0;
  const std::vector<Segment>& segments = path.segments();
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const Segment& before = segments[i - 1];
    jump = std::max(jump, std::abs(segments[i].curvature - before.CurvatureAt(before.length)));
  }
  return jump;
}

TEST(CurveTreePlanner, PlansCurvesThatTheWheelsCanFollowPastObstacles) {
  PlanRequest request = AroundAWall();
  for (const double start_speed : {0.0, 3.0}) {
    request.start_speed = start_speed;
    request.start_steering = start_speed > 0.0 ? 0.1 : 0.0;
    for (request.seed = 1; request.seed <= 3; ++request.seed) {
      const Plan plan = MakePlan(request, kCurves);
      ASSERT_TRUE(plan.ok()) << plan.reason;
      const Path& path = plan.reference.path;
      EXPECT_LE(LargestJump(path), Tolerance(1e-9));
      EXPECT_LE((path.At(path.length()).pose.position() - request.waypoints.back()).norm(),
                Tolerance(1e-9));
      EXPECT_NEAR(path.At(0.0).curvature,
                  start_speed > 0.0 ? CurvatureForSteering(request.vehicle, 0.1) : 0.0,
                  Tolerance(1e-9));
      for (double s = 0.0; s <= path.length(); s += 0.02) {
        // The farthest corner moves by less than 0.018 m within half a step.
        ASSERT_GE(Separation(FootprintAt(request.vehicle, path.At(s).pose), request.obstacles[0]),
                  kCurves.safe_distance - Tolerance(0.018))
            << "at " << s;
      }
    }
  }
}

TEST(CurveTreePlanner, MoreSamplesNeverLengthenTheDriveThroughTheTree) {
  const PlanRequest request = AroundAWall();
  double before = std::numeric_limits<double>::infinity();
  for (const int iterations : {30, 300, 3000}) {
    RrtStarPlannerOptions options = kCurves;
    options.iterations = iterations;
    const Plan plan = MakePlan(request, options);
    if (!plan.ok()) {
      EXPECT_EQ(plan.status, PlanStatus::kBudgetUsedUp);
      EXPECT_EQ(before, std::numeric_limits<double>::infinity());
      continue;
    }
    const nlohmann::json own = DiagnosticsJson(plan);
    const double length = own["legs"][0]["cost_m"].get<double>();
    // The shortest path of a point passes the upper corners of the wall.
    EXPECT_GE(length, std::hypot(29.5, 5.0) + 1.0 + std::hypot(29.5, 5.0));
    // All edges are driven at the mission's speed here, so cheaper paths are shorter.
    EXPECT_LE(length, before + Tolerance(1e-9));
    before = length;
  }
  EXPECT_LT(before, std::numeric_limits<double>::infinity());
}

TEST(CurveTreePlanner, GivesTreesWhoseEdgesAreAtLeastAsLongAsLines) {
  const Plan plan = MakePlan(AroundAWall(), kCurves);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const nlohmann::json own = DiagnosticsJson(plan);
  const auto nodes = [&](std::size_t leg) { return own["legs"][leg]["nodes"].get<std::size_t>(); };
  ASSERT_EQ(plan.tree.size(), nodes(0) + nodes(1));
  for (std::size_t i = 0; i < plan.tree.size(); ++i) {
    const TreeNode& node = plan.tree[i];
    const TreeNode& parent = plan.tree.at(node.parent);
    EXPECT_GE(node.cost - parent.cost,
              (node.position - parent.position).norm() * (1.0 - Tolerance(1e-12)));
  }
  EXPECT_EQ(plan.tree[1].cost, own["legs"][0]["cost_m"].get<double>());
}

TEST(CurveTreePlanner, DrawsNoSamplesWhereTheFastestCurveIsFree) {
  PlanRequest request = AroundAWall();
  request.start.yaw = 2.0;
  request.obstacles.clear();
  const Plan plan = MakePlan(request, kCurves);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_EQ(plan.diagnostics.samples, 0);
  EXPECT_EQ(plan.tree.size(), 4U);  // start and goal of both legs
}

TEST(CurveTreePlanner, MovesThePlanWithTheMission) {
  PlanRequest request = AroundAWall();
  const Plan plan = MakePlan(request, kCurves);
  const Pose2 frame{-12.0, 7.0, 2.1};
  PlanRequest moved = request;
  moved.start = frame;
  for (Vec2& waypoint : moved.waypoints) {
    waypoint = ToWorld(frame, waypoint);
  }
  moved.obstacles[0].center = Compose(frame, request.obstacles[0].center);
  const Plan same = MakePlan(moved, kCurves);
  ASSERT_TRUE(plan.ok() && same.ok()) << plan.reason << same.reason;
  const double length = plan.reference.path.length();
  ASSERT_NEAR(same.reference.path.length(), length, Tolerance(1e-6));
  for (double s = 0.0; s < length; s += 1.0) {
    // FasterRoute rounds its inputs to a millionth.
    EXPECT_LE(Apart(same.reference.path.At(s).pose, Compose(frame, plan.reference.path.At(s).pose)),
              Tolerance(1e-4));
  }
}

TEST(CurveTreePlanner, SaysWhichWaypointCurvesDoNotReach) {
  PlanRequest request = AroundAWall();
  // Four walls around the goal.
  request.obstacles = {{{50.0, 0.0, 0.0}, 1.0, 25.0},
                       {{72.0, 0.0, 0.0}, 1.0, 25.0},
                       {{61.0, 12.0, 0.0}, 23.0, 1.0},
                       {{61.0, -12.0, 0.0}, 23.0, 1.0}};
  RrtStarPlannerOptions options = kCurves;
  options.margin = 1.0;
  options.iterations = 50;
  options.trees = 2;
  const Plan plan = MakePlan(request, options);
  EXPECT_EQ(plan.status, PlanStatus::kBudgetUsedUp);
  EXPECT_THAT(plan.reason, HasSubstr("waypoint 1 not reached by curves through 50 samples"));
  EXPECT_EQ(DiagnosticsJson(plan)["trees"].size(), 2U);
  request.max_samples = 20 * 400;
  const Plan stopped = MakePlan(request, options);
  EXPECT_EQ(stopped.diagnostics.samples, 20 * 400);
  EXPECT_THAT(stopped.reason, HasSubstr("20 samples, the last of those allowed"));
}

TEST(CurveTreePlanner, RefusesStopsAtWhichTheCarDoesNotFit) {
  PlanRequest request = AroundAWall();
  request.obstacles.push_back({{60.0, 0.5, 0.0}, 1.0, 1.0});
  const Plan plan = MakePlan(request, kCurves);
  EXPECT_FALSE(plan.ok());
  EXPECT_EQ(plan.diagnostics.samples, 0);
}

TEST(CurveTreePlanner, TakesLessTimeThanRoundedCorners) {
  PlanRequest request = AroundAWall();
  for (const double yaw : {0.0, 1.5}) {
    request.start.yaw = yaw;
    const Plan curves = MakePlan(request, kCurves);
    const Plan lines = MakePlan(request, RrtStarPlannerOptions{});
    ASSERT_TRUE(curves.ok() && lines.ok()) << curves.reason << lines.reason;
    EXPECT_LT(DrivingTime(curves, request.vehicle), DrivingTime(lines, request.vehicle));
  }
}

}  // namespace curve_tree_planner_test
}  // namespace trackbed
