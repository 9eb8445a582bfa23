#include "trackbed/planning/sampling/rrt_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "src/planning/sampling/prune_waypoints.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/occupancy_grid.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/sampling/comparator.h"
#include "trackbed/planning/sampling/rrt.h"

// RRT as a planner of cars. Everything random happens in the frame of the car at its start, so that
// a mission that is moved or turned as a whole gets the same plan, moved or turned.
namespace trackbed {
namespace {

bool MayBePartial(const PlannerOptions& options) {
  const auto& own = options.Get<RrtPlannerOptions>();
  return own.partial.value_or(own.time_limit.has_value());
}

Pose2 InFrame(const Pose2& X_WF, const Pose2& X_WA) {
  const Vec2 position = ToLocal(X_WF, X_WA.position());
  return {position.x(), position.y(), X_WA.yaw - X_WF.yaw};
}

Vec2 DirectionInFrame(const Pose2& X_WF, const Vec2& vector) {
  return ToLocal({0.0, 0.0, X_WF.yaw}, vector);
}

/// The mission in the frame of the car at its start.
struct Task {
  Vec2 lead{0.0, 0.0};      ///< where the trees begin
  std::vector<Vec2> goals;  ///< one after the other
  std::vector<OrientedBox> obstacles;
  double inflation = 0.0;
  GridArea area;  ///< that is sampled
  WindScoring wind;
};

Task MakeTask(const RrtPlannerOptions& options, const PlanRequest& request) {
  const Pose2& frame = request.start;
  Task task;
  for (std::size_t i = 1; i < request.waypoints.size(); ++i) {
    task.goals.push_back(ToLocal(frame, request.waypoints[i]));
  }
  // No further than half way to where it is going.
  task.lead.x() = std::min(options.lead_in, 0.5 * task.goals.front().norm());
  for (const OrientedBox& box : request.obstacles) {
    task.obstacles.push_back({InFrame(frame, box.center), box.length, box.width});
  }
  task.inflation = 0.5 * request.vehicle.width + options.safe_distance +
                   (options.corners == Corners::kRound ? options.corner_room : 0.0);
  std::vector<Vec2> points = task.goals;
  points.push_back(task.lead);
  task.area = AreaAround({}, points, task.obstacles, options.margin);
  task.wind = {.wind = request.wind, .speed = request.speed.speed, .weight = options.wind_weight};
  task.wind.wind.velocity = DirectionInFrame(frame, request.wind.velocity);
  for (Gust& gust : task.wind.wind.gusts) {
    gust.velocity = DirectionInFrame(frame, gust.velocity);
    if (gust.area) {
      gust.area->center = InFrame(frame, gust.area->center);
    }
  }
  return task;
}

bool IsFree(const Task& task, const Vec2& from, const Vec2& to) {
  return std::all_of(task.obstacles.begin(), task.obstacles.end(), [&](const OrientedBox& box) {
    return Distance(from, to, box) > task.inflation;
  });
}

/// Tangent lengths of corners at the lowest speed, by their change of heading.
class Tangents {
 public:
  Tangents(const VehicleParams& vehicle, double speed) {
    for (std::size_t i = 1; i < kCount; ++i) {
      lengths_[i] = CornerAt(vehicle, static_cast<double>(i) * kStep, speed,
                             1.0 / vehicle.min_turning_radius())
                        .tangent_length;
    }
  }

  /// Never too short: of the next change of heading in the table.
  double operator()(double turn) const {
    const auto next = static_cast<std::size_t>(std::ceil(turn / kStep));
    return next < kCount ? lengths_[next] : std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr std::size_t kCount = 200;
  static constexpr double kStep = kPi / kCount;
  std::array<double, kCount> lengths_{};  // straight on needs none
};

/// A path through all goals, or how far it got.
struct Way {
  std::vector<Vec2> points;   ///< from the start on through the goals reached, in the car's frame
  std::size_t goals = 0;      ///< reached
  std::vector<Vec2> nearest;  ///< the tree's path toward the next one, to the node nearest to it
  double left = 0.0;          ///< from where it ends to the next goal [m]
  RrtStatus status = RrtStatus::kReached;
  std::vector<RrtLeg> legs;
  std::vector<TreeNode> tree;  ///< in the world
};

/// All that the trees of one request have in common.
struct Forest {
  const RrtPlannerOptions& options;
  const PlanRequest& request;
  const Task& task;
  const Tangents& tangents;
  std::function<bool()> time_is_over;  ///< empty: never
};

/// Adds the nodes of a tree, in the world, with the lengths of their ways.
void AddTree(const RrtResult& result, const Pose2& frame, std::vector<TreeNode>& tree) {
  const std::size_t first = tree.size();
  for (const RrtNode& node : result.nodes) {
    const Vec2& parent = result.nodes[node.parent].position;
    // A node's parent stands before it; the first one is its own.
    const double cost = tree.size() == first
                            ? 0.0
                            : tree[first + node.parent].cost + (node.position - parent).norm();
    tree.push_back({ToWorld(frame, node.position), first + node.parent, cost});
  }
}

std::vector<Vec2> InWorld(const Pose2& frame, std::vector<Vec2> points) {
  for (Vec2& point : points) {
    point = ToWorld(frame, point);
  }
  return points;
}

/// Goes on along a tree's path, smoothed, and with no more corners than it needs; `leg` is told.
void AddLeg(const Forest& forest, const std::vector<Vec2>& path, bool is_last,
            std::vector<Vec2>& points, RrtLeg& leg) {
  const RrtPlannerOptions& options = forest.options;
  const Task& task = forest.task;
  const SmoothingResult smooth =
      SmoothPath(path, task.obstacles, task.inflation, task.wind,
                 {.data = options.data_weight, .smoothness = options.smoothness_weight});
  leg.sweeps = smooth.sweeps;
  leg.smooth = InWorld(forest.request.start, smooth.path);
  const std::size_t before = points.size();
  const std::vector<Vec2> few = PruneWaypoints(
      smooth.path, {.before = before > 1 ? std::optional(points[before - 2]) : std::nullopt,
                    .first_leg = before <= 2,
                    .last_leg = is_last,
                    .obstacles = task.obstacles,
                    .inflation = task.inflation,
                    .wind = task.wind,
                    .corner_cost = options.corner_cost,
                    .tangent = forest.tangents});
  points.insert(points.end(), few.begin() + 1, few.end());
}

Way GrowWay(const Forest& forest, std::uint64_t seed) {
  const RrtPlannerOptions& options = forest.options;
  const Task& task = forest.task;
  const Pose2& frame = forest.request.start;
  Way way;
  way.points.emplace_back(0.0, 0.0);
  if (task.lead.x() > 0.0) {
    way.points.push_back(task.lead);
  }
  Vec2 from = task.lead;
  for (const Vec2& goal : task.goals) {
    const RrtResult tree = PlanRrt({.start = from,
                                    .goal = goal,
                                    .low = task.area.low,
                                    .high = task.area.high,
                                    .obstacles = task.obstacles,
                                    .inflation = task.inflation},
                                   {.iterations = options.iterations,
                                    .expand_distance = options.expand_distance,
                                    .goal_bias = options.goal_bias,
                                    .stop = forest.time_is_over},
                                   seed + way.goals);
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

/// One try: the plan along a path, and what the comparator says of it.
struct Try {
  Way way;
  Plan plan;
  PathScore score;

  [[nodiscard]] bool is_partial() const { return way.status != RrtStatus::kReached; }
};

/// A plan to the goal is better than one for part of the way, that than none.
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

/// What there was to look with: "10 trees of 10000 samples", "1 tree in 0.5 s".
std::string DescribeBudget(const RrtPlannerOptions& options, std::size_t trees, bool time_is_over) {
  return fmt::format("{} {} ", trees, trees == 1 ? "tree" : "trees") +
         (time_is_over ? fmt::format("in {:.4g} s", *options.time_limit)
                       : fmt::format("of {} samples", options.iterations));
}

/// Where a tree begins is free: it is checked, or was a goal.
Plan RefusedAs(const Way& way, const Forest& forest) {
  const double inflation = forest.task.inflation;
  if (way.status == RrtStatus::kGoalBlocked) {
    return route::Refused(PlanStatus::kGoalBlocked,
                          fmt::format("an obstacle is closer than {:.3g} m to waypoint {}",
                                      inflation, way.goals + 1));
  }
  return route::Refused(
      PlanStatus::kBudgetUsedUp,
      fmt::format("ends {:.3g} m from waypoint {}; obstacles are inflated by {:.3g} m", way.left,
                  way.goals + 1, inflation));
}

Plan PlanAlongRoute(const Forest& forest, const std::vector<Vec2>& points) {
  Plan plan = route::AlongPolyline({}, forest.request, InWorld(forest.request.start, points),
                                   forest.options.corners, forest.options.safe_distance,
                                   forest.options.min_speed);
  Plan tested = MakeFeasible(plan, forest.request);
  return tested.ok() ? plan : tested;
}

/// Plans along a path that does not reach its next goal: to the node nearest to that or, where the
/// car cannot get there or stand there, as its nose reaches further than the node, to the last one
/// before it where it can.
void TakePart(const Forest& forest, Try& next) {
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
      break;  // it stands where it is
    }
    next.plan = PlanAlongRoute(forest, points);
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

Try TryTree(const Forest& forest, std::uint64_t seed) {
  Try next;
  next.way = GrowWay(forest, seed);
  if (!next.is_partial()) {
    next.plan = PlanAlongRoute(forest, next.way.points);
  } else if (MayBePartial(forest.options) && !next.way.nearest.empty()) {
    TakePart(forest, next);
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

/// Says of a plan that leads nowhere, or part of the way, how far trees came with what they had.
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

}  // namespace

namespace {

Plan PlanTrees(const RrtPlannerOptions& options, const PlanRequest& request) {
  const Task task = MakeTask(options, request);
  if (!IsFree(task, {0.0, 0.0}, task.lead)) {
    return route::Refused(
        PlanStatus::kStartBlocked,
        fmt::format("an obstacle is closer than {:.3g} m to the first {:.3g} m of straight path",
                    task.inflation, task.lead.x()));
  }
  const Tangents tangents(request.vehicle, std::min(options.min_speed, request.speed.speed));
  Forest forest{options, request, task, tangents, {}};
  if (options.time_limit && request.clock) {
    const double end = request.clock() + *options.time_limit;
    forest.time_is_over = [&request, end] { return request.clock() >= end; };
  }
  std::optional<Try> best;
  RrtDiagnostics diagnostics;
  bool time_is_over = false;
  for (int i = 0; i < options.trees && !time_is_over; ++i) {
    Try next = TryTree(forest, request.seed + (static_cast<std::uint64_t>(i) << 32U));
    diagnostics.trees.push_back(FindingsOn(next));
    const RrtStatus status = next.way.status;
    const bool hopeless = status == RrtStatus::kGoalBlocked;  // so it is for every tree
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
  if (plan.ok()) {
    plan.tree = std::move(best->way.tree);
  }
  return plan;
}

Plan PlanWith(const RrtPlannerOptions& options, const PlanRequest& request) {
  if (Plan refused = route::CheckRoute(request); !refused.ok()) {
    return refused;
  }
  TRACKBED_CHECK(options.trees > 0 && options.time_limit.value_or(1.0) > 0.0,
                 "{} trees, time limit {}", options.trees, options.time_limit.value_or(0.0));
  Plan plan = PlanTrees(options, request);
  const bool too_near =
      plan.status == PlanStatus::kTurnTooTight || plan.status == PlanStatus::kInfeasible;
  if (!too_near || options.corners == Corners::kRefuse || request.start_speed == 0.0) {
    return plan;
  }
  // A rolling car may need more room before its first corner than the trees leave.
  RrtPlannerOptions longer = options;
  longer.lead_in += 0.5 * request.start_speed * request.start_speed / request.speed.deceleration +
                    request.vehicle.min_turning_radius();
  Plan again = PlanTrees(longer, request);
  return again.ok() ? again : plan;
}

}  // namespace

PlannerEntry RrtPlanner() {
  return {.name = "rrt",
          .summary = "RRT around obstacles (LaValle 1998), smoothed, wind-aware",
          .defaults = RrtPlannerOptions{},
          .plan = PlanBy<RrtPlannerOptions, PlanWith>,
          .min_waypoints = 2,
          .keeps_clear = true,
          .searches = true,
          .is_random = true,
          .may_be_partial = MayBePartial};
}

}  // namespace trackbed
