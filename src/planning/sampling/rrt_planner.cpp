#include "trackbed/planning/sampling/rrt_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>

#include "src/planning/sampling/prune_waypoints.h"
#include "src/planning/sampling/sampling_task.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/corner_room.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/sampling/comparator.h"
#include "trackbed/planning/sampling/rrt.h"

// Implements the RRT planner for cars (LaValle 1998), with the smoothing and the comparator of the
// wind-aware RRT. In each try, the planner grows one tree per waypoint, smooths the path, removes
// needless waypoints and rounds the corners. If a tree does not reach its goal, the planner may
// plan a partial path to the node nearest to the goal. The planner prefers complete plans to
// partial plans. The comparator selects the best of the complete plans.
namespace trackbed {
namespace {

bool MayBePartial(const PlannerOptions& options) {
  const auto& own = options.Get<RrtPlannerOptions>();
  return own.partial.value_or(own.time_limit.has_value());
}

/// Reports a problem if the smoothing does not converge with the given weights.
std::vector<OptionProblem> CheckSmoothing(const RrtPlannerOptions& options,
                                          const CouldReadKey& could_read) {
  const double step = options.data_weight + 2.0 * options.smoothness_weight;
  if (!could_read("data_weight") || !could_read("smoothness_weight") ||
      (step > 0.0 && step < 1.0)) {
    return {};
  }
  return {{"smoothness_weight",
           fmt::format("data_weight + 2 smoothness_weight is {:.4g}; must be above 0 and below 1 "
                       "for the smoothing to converge",
                       step)}};
}

/// Checks the options for detours. The check rejects a wall-clock limit, because detours must be
/// reproducible. The check rejects the option of partial plans, because a detour must return to the
/// route.
std::vector<OptionProblem> CheckDetour(const RrtPlannerOptions& options) {
  std::vector<OptionProblem> problems;
  if (options.time_limit) {
    problems.push_back({"time_limit",
                        "not allowed in a detour, whose planning must be repeatable; use "
                        "iterations"});
  }
  if (options.partial.value_or(false)) {
    problems.push_back({"partial", "not allowed in a detour, which must return to the route"});
  }
  return problems;
}

/// A path through all goals, or only through the goals before the first goal that a tree did not
/// reach.
struct TreePath {
  /// Points from the start through the reached goals, in the car's start frame.
  std::vector<Vec2> points;
  std::size_t goals = 0;      ///< Number of goals reached.
  std::vector<Vec2> nearest;  ///< Path along the tree to the node nearest to the next goal.
  double left = 0.0;          ///< Distance between the next goal and the tree's nearest node [m].
  RrtStatus status = RrtStatus::kReached;
  std::vector<RrtLeg> legs;
  std::vector<TreeNode> tree;  ///< nodes of all trees, in the world frame
};

/// Data that all trees of one request share.
struct Forest {
  const RrtPlannerOptions& options;
  const PlanRequest& request;
  const SamplingTask& task;
  const CornerTangents& tangents;
  /// Function that returns whether the time limit has passed; empty without a time limit.
  std::function<bool()> time_is_over;
};

/// Appends the nodes of a tree to `tree`, in the world frame. The cost of a node is the length of
/// the path from the root to this node.
void AddTree(const RrtResult& result, const Pose2& frame, std::vector<TreeNode>& tree) {
  const std::size_t first = tree.size();
  for (const RrtNode& node : result.nodes) {
    const Vec2& parent = result.nodes[node.parent].position;
    // Each parent node precedes its children; the root is its own parent.
    const double cost = tree.size() == first
                            ? 0.0
                            : tree[first + node.parent].cost + (node.position - parent).norm();
    tree.push_back({ToWorld(frame, node.position), first + node.parent, cost});
  }
}

/// Smooths a tree's path, removes needless corners and appends the path to `points`. Stores the
/// results for this leg in `leg`.
void AddLeg(const Forest& forest, const std::vector<Vec2>& path, bool is_last,
            std::vector<Vec2>& points, RrtLeg& leg) {
  const RrtPlannerOptions& options = forest.options;
  const SamplingTask& task = forest.task;
  const SmoothingResult smooth =
      SmoothPath(path, task.obstacles, task.inflation, task.wind,
                 {.data = options.data_weight, .smoothness = options.smoothness_weight});
  leg.sweeps = smooth.sweeps;
  leg.smooth = InWorld(forest.request.start, smooth.path);
  AddPruned(task, forest.tangents, options.corner_cost, smooth.path, is_last, points);
}

TreePath GrowPath(const Forest& forest, std::uint64_t seed, long& samples) {
  const RrtPlannerOptions& options = forest.options;
  const SamplingTask& task = forest.task;
  const Pose2& frame = forest.request.start;
  TreePath way;
  way.points = task.departure;
  Vec2 from = task.departure.back();
  for (const Vec2& goal : task.goals) {
    const RrtResult tree =
        PlanRrt({.start = from,
                 .goal = goal,
                 .low = task.area.low,
                 .high = task.area.high,
                 .obstacles = task.obstacles,
                 .inflation = task.inflation},
                {.iterations = static_cast<int>(std::min<long>(
                     options.iterations, std::max(forest.request.max_samples - samples, 0L))),
                 .expand_distance = options.expand_distance,
                 .goal_bias = options.goal_bias,
                 .stop = forest.time_is_over},
                seed + way.goals);
    samples += tree.iterations;
    AddTree(tree, frame, way.tree);
    way.legs.push_back({.status = tree.status,
                        .iterations = tree.iterations,
                        .nodes = tree.nodes.size(),
                        .length = tree.length,
                        .path = InWorld(frame, tree.path),
                        .sweeps = {},
                        .smooth = {}});
    if (!tree.ok()) {
      way.status = tree.status;
      way.nearest = tree.path;
      way.left = tree.path.empty() ? std::numeric_limits<double>::infinity()
                                   : (goal - tree.path.back()).norm();
      return way;
    }
    AddLeg(forest, tree.path, way.goals + 1 == task.goals.size(), way.points, way.legs.back());
    from = goal;
    ++way.goals;
  }
  return way;
}

/// One attempt: a path, its plan, and the comparator's score.
struct Try {
  TreePath way;
  Plan plan;
  std::optional<Plan> rejected{};  ///< The plan before MakeFeasible rejected it.
  PathScore score;

  [[nodiscard]] bool is_partial() const { return way.status != RrtStatus::kReached; }
};

/// Returns whether the attempt `other` is better than the attempt `current`. Complete plans are
/// better than partial plans, and partial plans are better than failures. Complete plans are
/// compared by the comparator's score. Among partial plans and among failures, the number of
/// reached goals decides, then the distance to the next goal.
bool IsBetterTry(const Try& other, const Try& current) {
  const auto rank = [](const Try& each) { return !each.plan.ok() ? 0 : each.is_partial() ? 1 : 2; };
  if (rank(other) != rank(current)) {
    return rank(other) > rank(current);
  }
  if (rank(other) == 2) {
    return IsBetter(other.score, current.score);
  }
  return std::pair(other.way.goals, -other.way.left) >
         std::pair(current.way.goals, -current.way.left);
}

/// Returns the description of the used budget, for example "10 trees of 10000 samples" or "1 tree
/// in 0.5 s".
std::string DescribeBudget(const RrtPlannerOptions& options, std::size_t trees, bool time_is_over) {
  return fmt::format("{} {} ", trees, trees == 1 ? "tree" : "trees") +
         (time_is_over ? fmt::format("in {:.4g} s", *options.time_limit)
                       : fmt::format("of {} samples", options.iterations));
}

/// Returns the refused plan for the case that no path was found. A blocked start of the last tree
/// cannot be the reason for the failure, because the start was checked or is a goal that was
/// reached.
Plan RefusedAs(const TreePath& way, const Forest& forest) {
  if (way.status == RrtStatus::kGoalBlocked) {
    return route::GoalBlocked(forest.request, way.goals + 1, forest.options.safe_distance);
  }
  return route::Refused(
      PlanStatus::kBudgetUsedUp,
      fmt::format("ends {:.3g} m from waypoint {}; obstacles are inflated by {:.3g} m", way.left,
                  way.goals + 1, forest.task.inflation.most));
}

/// Plans along the points. If the plan is not feasible, stores the plan in `next.rejected`.
void PlanAlongRoute(const Forest& forest, const std::vector<Vec2>& points, Try& next) {
  TreesPlan along = PlanAlong(forest.options, forest.request, points);
  next.plan = std::move(along.plan);
  next.rejected = std::move(along.rejected);
}

/// Plans a partial path that ends at the tree's node nearest to the next goal, because the tree did
/// not reach this goal. The car may be unable to stop at the nearest node, because the front of the
/// car extends beyond the node. If the car cannot stop there, the plan ends at the last earlier
/// node of the tree's path to which a feasible plan exists.
void UsePartialPath(const Forest& forest, Try& next) {
  const std::vector<Vec2> reached = next.way.points;
  const std::vector<Vec2> nearest = next.way.nearest;
  const Vec2& goal = forest.task.goals[next.way.goals];
  const Plan refused = RefusedAs(next.way, forest);
  std::string why;
  for (std::size_t nodes = nearest.size(); nodes > 0; --nodes) {
    std::vector<Vec2> points = reached;
    RrtLeg leg = next.way.legs.back();
    if (nodes > 1) {
      const std::vector<Vec2> part(nearest.begin(),
                                   nearest.begin() + static_cast<std::ptrdiff_t>(nodes));
      AddLeg(forest, part, true, points, leg);
    }
    if (points.size() < 2) {
      break;  // the car would not move
    }
    PlanAlongRoute(forest, points, next);
    if (next.plan.ok()) {
      next.way.points = points;
      next.way.left = (goal - points.back()).norm();
      next.way.legs.back() = leg;
      return;
    }
    why = why.empty() ? next.plan.reason : why;
  }
  next.plan = refused;
  next.plan.reason += why.empty() ? "" : "; not feasible: " + why;
}

Try TryTree(const Forest& forest, std::uint64_t seed, long& samples) {
  Try next;
  next.way = GrowPath(forest, seed, samples);
  if (!next.is_partial()) {
    PlanAlongRoute(forest, next.way.points, next);
  } else if (MayBePartial(forest.options) && !next.way.nearest.empty()) {
    UsePartialPath(forest, next);
  } else {
    next.plan = RefusedAs(next.way, forest);
  }
  if (!next.is_partial() || next.plan.ok()) {
    next.score = ScorePath(InPieces(next.way.points), {0.0, 0.0}, forest.task.obstacles,
                           forest.task.inflation, forest.task.wind, {});
  }
  return next;
}

RrtTreeFindings FindingsOn(const Try& each) {
  RrtTreeFindings found{each.plan.status, each.plan.reason, each.score, std::nullopt};
  if (each.plan.ok() && each.is_partial()) {
    found.remaining = each.way.left;
  }
  return found;
}

/// Adds the search budget and the remaining distance to the goal to the text of a failed or partial
/// plan.
void RecordBudget(const Forest& forest, const Try& best, const std::string& budget, Plan& plan,
                  RrtDiagnostics& diagnostics) {
  if (plan.status == PlanStatus::kBudgetUsedUp) {
    plan.reason = fmt::format("goal not reached by {}: the nearest path {}", budget, plan.reason);
  } else if (plan.ok() && best.is_partial()) {
    const std::size_t waypoint = best.way.goals + 1;
    plan.goal = PlannedStops(forest.request).back();
    plan.partial = fmt::format("ends {:.3g} m from waypoint {}, the nearest feasible path of {}",
                               best.way.left, waypoint, budget);
    diagnostics.partial = {waypoint, best.way.left, plan.partial};
  }
}

TreesPlan PlanTrees(const RrtPlannerOptions& options, const PlanRequest& request,
                    const std::vector<Vec2>& departure) {
  const SamplingTask task = TaskOf(options, request, departure, options.wind_weight);
  if (Plan refused = CheckLeadIn(task, request, options.safe_distance); !refused.ok()) {
    return {std::move(refused)};
  }
  const CornerTangents tangents(request.vehicle, std::min(options.min_speed, request.speed.speed));
  Forest forest{options, request, task, tangents, {}};
  if (options.time_limit && request.clock) {
    const double end = request.clock() + *options.time_limit;
    forest.time_is_over = [&request, end] { return request.clock() >= end; };
  }
  std::optional<Try> best;
  RrtDiagnostics diagnostics;
  bool time_is_over = false;
  long samples = 0;
  const auto may_go_on = [&] { return samples < request.max_samples && !time_is_over; };
  for (int i = 0; i < options.trees && (i == 0 || may_go_on()); ++i) {
    Try next = TryTree(forest, request.seed + (static_cast<std::uint64_t>(i) << 32U), samples);
    diagnostics.trees.push_back(FindingsOn(next));
    const RrtStatus status = next.way.status;
    // No tree can reach a blocked goal.
    const bool hopeless = status == RrtStatus::kGoalBlocked;
    if (!best || hopeless || IsBetterTry(next, *best)) {
      best = std::move(next);
      diagnostics.chosen = i;
    }
    if (hopeless) {
      break;
    }
    time_is_over = status == RrtStatus::kStopped ||
                   (i + 1 < options.trees && forest.time_is_over && forest.time_is_over());
  }
  Plan plan = std::move(best->plan);
  RecordBudget(forest, *best, DescribeBudget(options, diagnostics.trees.size(), time_is_over), plan,
               diagnostics);
  diagnostics.legs = std::move(best->way.legs);
  plan.diagnostics.planner = std::move(diagnostics);
  plan.diagnostics.samples = samples;
  if (plan.ok()) {
    plan.tree = std::move(best->way.tree);
  }
  return {std::move(plan), std::move(best->rejected)};
}

Plan PlanWith(const RrtPlannerOptions& options, const PlanRequest& request) {
  if (Plan refused = route::CheckRoute(request); !refused.ok()) {
    return refused;
  }
  TRACKBED_CHECK(options.trees > 0 && options.time_limit.value_or(1.0) > 0.0,
                 "{} trees, time limit {}", options.trees, options.time_limit.value_or(0.0));
  // With a time limit, try only one lead-in, because each lead-in would use the whole time limit
  // again.
  const int lead_ins = options.time_limit ? 1 : kLeadIns;
  // With a time limit, do not plan again with less room at corners, because the limit is for a
  // single search. In the wind, do not plan again either, because the shortest path need not be the
  // best one.
  const bool is_calm = request.wind.velocity == Vec2(0.0, 0.0) && request.wind.gusts.empty();
  const bool has_room = options.corners == Corners::kRound && !options.time_limit &&
                        (is_calm || options.wind_weight == 0.0);
  return WithLessCornerRoom(request, has_room ? options.corner_room : 0.0,
                            [&](const PlanRequest& own, double corner_room) {
                              RrtPlannerOptions with = options;
                              with.corner_room = has_room ? corner_room : options.corner_room;
                              return PlanWithLeadIn(with, own, PlanTrees, lead_ins);
                            });
}

}  // namespace

PlannerEntry RrtPlanner() {
  return {.name = "rrt",
          .summary = "RRT around obstacles (LaValle 1998), smoothed, wind-aware",
          .defaults = RrtPlannerOptions{},
          .plan = PlanBy<RrtPlannerOptions, PlanWith>,
          .min_waypoints = 2,
          .keeps_clear = true,
          .bounds_waypoint_miss = true,
          .searches = true,
          .is_random = true,
          .may_be_partial = MayBePartial,
          .check = OnOptions<RrtPlannerOptions, CheckSmoothing>,
          .check_detour = OnOptions<RrtPlannerOptions, CheckDetour>};
}

void Visit(KeyVisitor& keys, RrtPlannerOptions& options) {
  VisitTaskKeys(keys, options);
  keys.Field({"trees", "", "number of trees; the best feasible path of all is the plan"},
             options.trees, Need::kOptional, Range{.min = 1, .max = 1000});
  keys.Field({"iterations", "", "maximum samples per leg and tree"}, options.iterations,
             Need::kOptional, Range{.min = 0, .max = 1e6});
  keys.Field({"time_limit", "s",
              "wall-clock time limit of the tree growth; makes the plan depend on the machine's "
              "speed, unlike `iterations`; default: none"},
             options.time_limit, kPositive);
  keys.Field({"partial", "",
              "whether to use the path to the node nearest to the goal if no tree reaches it; "
              "default: true with a time_limit"},
             options.partial);
  keys.Field({"expand_distance", "m", "maximum distance from a node toward a sample"},
             options.expand_distance, Need::kOptional, kPositive);
  keys.Field({"goal_bias", "", "fraction of samples at the goal"}, options.goal_bias,
             Need::kOptional, Range{.min = 0.0, .max = 1.0});
  keys.Field({"data_weight", "", "alpha of the smoothing: attraction to the original points"},
             options.data_weight, Need::kOptional, Range{.min = 0.0, .max = 1.0});
  keys.Field({"smoothness_weight", "",
              "beta of the smoothing: attraction to the neighbors' midpoint; data_weight + 2 "
              "smoothness_weight must be above 0 and below 1"},
             options.smoothness_weight, Need::kOptional, Range{.min = 0.0, .max = 0.5});
  keys.Field(kCornerCost, options.corner_cost, Need::kOptional, kNonNegative);
  keys.Field({"wind_weight", "", "weight of the wind in the path length; 0: ignored"},
             options.wind_weight, Need::kOptional, kNonNegative);
}

}  // namespace trackbed
