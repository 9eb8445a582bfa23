#include "trackbed/planning/sampling/rrt_star_planner.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/planning/curves/clothoid_keys.h"
#include "src/planning/sampling/curve_tree_planner.h"
#include "src/planning/sampling/sampling_task.h"
#include "trackbed/core/error.h"
#include "trackbed/geometry/box_index.h"
#include "trackbed/planning/common/corner_room.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/route.h"

namespace trackbed {
namespace {

/// Returns the failed plan for a tree that did not reach the waypoint `waypoint` from the previous
/// waypoint.
Plan StarRefused(const RrtStarPlannerOptions& options, const PlanRequest& request,
                 const SamplingTask& task, const RrtStarResult& tree, std::size_t waypoint) {
  if (tree.status == RrtStarStatus::kGoalBlocked) {
    return route::GoalBlocked(request, waypoint, options.safe_distance);
  }
  double left = (task.goals[waypoint - 1] - tree.nodes.front().position).norm();
  for (const TreeNode& node : tree.nodes) {
    left = std::min(left, (task.goals[waypoint - 1] - node.position).norm());
  }
  return route::Refused(
      PlanStatus::kBudgetUsedUp,
      fmt::format("waypoint {} not reached by {} samples{}: the nearest node is {:.3g} m away; "
                  "obstacles are inflated by {:.3g} m",
                  waypoint, tree.iterations,
                  tree.iterations < options.iterations ? ", the last of those allowed" : "", left,
                  task.inflation.most));
}

/// Appends the nodes of a tree to `tree`, in the world frame. The parent of the root is the root
/// itself.
void AddNodes(const RrtStarResult& result, const Pose2& frame, std::vector<TreeNode>& tree) {
  const std::size_t first = tree.size();
  for (const TreeNode& node : result.nodes) {
    tree.push_back({ToWorld(frame, node.position), first + node.parent, node.cost});
  }
}

/// Finds the path between two waypoints: the straight line, if it is free and not longer than the
/// tree's steps can reach; otherwise a path from an RRT* tree.
RrtStarResult GrowLeg(const RrtStarPlannerOptions& options, const SamplingTask& task,
                      const BoxIndex& obstacles, const Vec2& from, const Vec2& to,
                      std::uint64_t seed, long max_samples) {
  const double length = (to - from).norm();
  const double edge =
      options.expand_distance.value_or(0.2 * (task.area.high - task.area.low).norm());
  if (length > 0.0 && length <= options.iterations * edge &&
      obstacles.KeepsFrom(from, to, task.inflation)) {
    return {.status = RrtStarStatus::kFound,
            .path = {from, to},
            .cost = length,
            .iterations = 0,
            .nodes = {{from, 0, 0.0}, {to, 0, length}}};
  }
  return PlanRrtStar({.start = from,
                      .goal = to,
                      .low = task.area.low,
                      .high = task.area.high,
                      .obstacles = task.obstacles,
                      .inflation = task.inflation},
                     {.iterations = static_cast<int>(
                          std::min<long>(options.iterations, std::max(max_samples, 0L))),
                      .step = options.expand_distance.value_or(0.0),
                      .goal_bias = options.goal_bias,
                      .informed = true,
                      .stop = {}},
                     seed);
}

/// Plans a path through all waypoints, with one tree per leg. Stores the legs of the plan in
/// `diagnostics`.
TreesPlan PlanStarTree(const RrtStarPlannerOptions& options, const PlanRequest& request,
                       const SamplingTask& task, const CornerTangents& tangents, std::uint64_t seed,
                       RrtStarPlanDiagnostics& diagnostics, long& samples) {
  diagnostics.legs.clear();
  const BoxIndex obstacles(task.obstacles);
  std::vector<Vec2> points = task.departure;
  std::vector<TreeNode> tree;
  Vec2 from = points.back();
  for (std::size_t i = 0; i < task.goals.size(); ++i) {
    const RrtStarResult found = GrowLeg(options, task, obstacles, from, task.goals[i], seed + i,
                                        request.max_samples - samples);
    samples += found.iterations;
    diagnostics.legs.push_back({.status = found.status,
                                .iterations = found.iterations,
                                .nodes = found.nodes.size(),
                                .cost = found.ok() ? std::optional(found.cost) : std::nullopt,
                                .path = InWorld(request.start, found.path)});
    if (!found.ok()) {
      return {StarRefused(options, request, task, found, i + 1)};
    }
    AddNodes(found, request.start, tree);
    AddPruned(task, tangents, options.corner_cost, found.path, i + 1 == task.goals.size(), points);
    from = task.goals[i];
  }
  TreesPlan along = PlanAlong(options, request, points);
  if (along.plan.ok()) {
    along.plan.tree = std::move(tree);
  }
  return along;
}

TreesPlan PlanStarTrees(const RrtStarPlannerOptions& options, const PlanRequest& request,
                        const std::vector<Vec2>& departure) {
  const SamplingTask task = TaskOf(options, request, departure, 0.0);
  if (Plan refused = CheckLeadIn(task, request, options.safe_distance); !refused.ok()) {
    return {std::move(refused)};
  }
  const CornerTangents tangents(request.vehicle, std::min(options.min_speed, request.speed.speed));
  RrtStarPlanDiagnostics diagnostics;
  TreesPlan found;
  Plan& plan = found.plan;
  long samples = 0;
  for (int i = 0; i < options.trees && (i == 0 || samples < request.max_samples); ++i) {
    found =
        PlanStarTree(options, request, task, tangents,
                     request.seed + (static_cast<std::uint64_t>(i) << 32U), diagnostics, samples);
    diagnostics.trees.push_back({plan.status, plan.reason});
    if (plan.ok() || plan.status == PlanStatus::kGoalBlocked) {
      break;  // no tree can reach a blocked goal
    }
  }
  plan.diagnostics.planner = std::move(diagnostics);
  plan.diagnostics.samples = samples;
  return found;
}

Plan PlanStar(const RrtStarPlannerOptions& options, const PlanRequest& request) {
  if (Plan refused = route::CheckRoute(request); !refused.ok()) {
    return refused;
  }
  TRACKBED_CHECK(options.trees > 0, "{} trees", options.trees);
  if (options.edges == TreeEdges::kCurves) {
    return PlanCurveTrees(options, request);
  }
  const double room = options.corners == Corners::kRound ? options.corner_room : 0.0;
  return WithLessCornerRoom(request, room, [&](const PlanRequest& own, double corner_room) {
    RrtStarPlannerOptions with = options;
    with.corner_room = corner_room;
    return PlanWithLeadIn(with, own, PlanStarTrees, kLeadIns);
  });
}

}  // namespace

void Visit(DiagnosticsVisitor& out, const RrtStarLeg& leg) {
  out.Text("status", ToString(leg.status));
  out.Integer("iterations", leg.iterations);
  out.Integer("nodes", leg.nodes);
  if (leg.cost) {
    out.Number("cost_m", *leg.cost);
  }
  if (out.full()) {
    out.Points("path_m", leg.path);
  }
}

void Visit(DiagnosticsVisitor& out, const RrtStarTreeFindings& own) {
  out.Text("status", ToString(own.status));
  out.Text("reason", own.reason);
}

void Visit(DiagnosticsVisitor& out, const RrtStarPlanDiagnostics& own) {
  out.List("legs", own.legs);
  out.List("trees", own.trees);
}

void Visit(KeyVisitor& keys, RrtStarPlannerOptions& options) {
  static const EnumNames<TreeEdges> edges{{TreeEdges::kLines, "lines"},
                                          {TreeEdges::kCurves, "curves"}};
  keys.Field({"edges", "",
              "edges of the trees: straight lines, whose corners are rounded, or curves of "
              "continuous curvature, which have no corners"},
             options.edges, Need::kOptional, edges);
  VisitTaskKeys(keys, options);
  keys.Field({"trees", "", "maximum number of trees; the first feasible path is the plan"},
             options.trees, Need::kOptional, Range{.min = 1, .max = 1000});
  keys.Field({"iterations", "", "samples per leg and tree"}, options.iterations, Need::kOptional,
             Range{.min = 0, .max = 1e6});
  keys.Field({"expand_distance", "m",
              "maximum distance from a node toward a sample; default: a fifth of the search area's "
              "diagonal"},
             options.expand_distance, kPositive);
  keys.Field({"goal_bias", "", "fraction of samples at the goal until it is reached"},
             options.goal_bias, Need::kOptional, Range{.min = 0.0, .max = 1.0});
  keys.Field(kCornerCost, options.corner_cost, Need::kOptional, kNonNegative);
  VisitClothoids(keys, options.max_lateral_acceleration, options.max_steering_rate_fraction);
}

PlannerEntry RrtStarPlanner() {
  return {.name = "rrt_star",
          .summary = "RRT* around obstacles (Karaman and Frazzoli 2011), with corners or curves",
          .defaults = RrtStarPlannerOptions{},
          .plan = PlanBy<RrtStarPlannerOptions, PlanStar>,
          .min_waypoints = 2,
          .keeps_clear = true,
          .bounds_waypoint_miss = true,
          .searches = true,
          .is_random = true};
}

}  // namespace trackbed
