#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "src/planning/few_corners.h"
#include "src/planning/route_planners.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/comparator.h"
#include "trackbed/planning/occupancy_grid.h"
#include "trackbed/planning/rrt.h"

// RRT as a planner of cars. Everything random happens in the frame of the car at its start, so that
// a mission that is moved or turned as a whole gets the same plan, moved or turned.
namespace trackbed {
namespace {

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

Task TaskOf(const RrtPlannerOptions& options, const PlanRequest& request) {
  const Pose2& frame = request.start;
  Task task;
  for (std::size_t i = 1; i < request.waypoints.size(); ++i) {
    task.goals.push_back(ToLocal(frame, request.waypoints[i]));
  }
  // No further than half way to where it is going.
  task.lead.x() = std::min(options.lead_in, 0.5 * task.goals.front().norm());
  for (const OrientedBox& box : request.obstacles) {
    task.obstacles.push_back({InFrame(frame, box.centre), box.length, box.width});
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
      gust.area->centre = InFrame(frame, gust.area->centre);
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

/// A way through all goals, or how far it got.
struct Way {
  std::vector<Vec2> points;  ///< from the start on, in the car's frame
  std::size_t goals = 0;     ///< reached
  double left = 0.0;         ///< to the next one, from the nearest node [m]
  RrtStatus status = RrtStatus::kReached;
  nlohmann::json legs = nlohmann::json::array();
  std::vector<RrtStarNode> tree;  ///< in the world
};

/// Adds the nodes of a tree, in the world, with the lengths of their ways.
void AddTree(const RrtResult& result, const Pose2& frame, std::vector<RrtStarNode>& tree) {
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

Way GrowWay(const RrtPlannerOptions& options, const Task& task, const Tangents& tangents,
            const Pose2& frame, std::uint64_t seed) {
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
                                    .stop = {}},
                                   seed + way.goals);
    AddTree(tree, frame, way.tree);
    way.legs.push_back({{"status", ToString(tree.status)},
                        {"iterations", tree.iterations},
                        {"nodes", tree.nodes.size()},
                        {"length_m", tree.length},
                        {"path_m", route::ToJson(InWorld(frame, tree.path))}});
    if (!tree.ok()) {
      way.status = tree.status;
      way.left = tree.path.empty() ? std::numeric_limits<double>::infinity()
                                   : (goal - tree.path.back()).norm();
      return way;
    }
    const SmoothingResult smooth =
        SmoothPath(tree.path, task.obstacles, task.inflation, task.wind,
                   {.data = options.data_weight, .smoothness = options.smoothness_weight});
    way.legs.back()["sweeps"] = smooth.sweeps;
    way.legs.back()["smooth_m"] = route::ToJson(InWorld(frame, smooth.path));
    const std::size_t before = way.points.size();
    const std::vector<Vec2> few = WithFewCorners(
        smooth.path, {.before = before > 1 ? std::optional(way.points[before - 2]) : std::nullopt,
                      .first_leg = before <= 2,
                      .last_leg = way.goals + 1 == task.goals.size(),
                      .obstacles = task.obstacles,
                      .inflation = task.inflation,
                      .wind = task.wind,
                      .corner_cost = options.corner_cost,
                      .tangent = tangents});
    way.points.insert(way.points.end(), few.begin() + 1, few.end());
    from = goal;
    ++way.goals;
  }
  return way;
}

/// One try: the plan along a way, and what the comparator says of it.
struct Try {
  Way way;
  Plan plan;
  WayScore score;
};

bool IsBetterTry(const Try& other, const Try& current) {
  if (other.plan.ok() != current.plan.ok()) {
    return other.plan.ok();
  }
  if (other.plan.ok()) {
    return IsBetter(other.score, current.score);
  }
  return std::pair(other.way.goals, -other.way.left) >
         std::pair(current.way.goals, -current.way.left);
}

/// Where a tree begins is free: it is checked, or was a goal.
Plan RefusedAs(const Way& way, const RrtPlannerOptions& options, const Task& task) {
  if (way.status == RrtStatus::kGoalBlocked) {
    return route::Refused(PlanStatus::kGoalBlocked,
                          fmt::format("an obstacle is nearer than {:.3g} m to waypoint {}",
                                      task.inflation, way.goals + 1));
  }
  return route::Refused(
      PlanStatus::kBudgetUsedUp,
      fmt::format("the nearest of {} trees of {} samples ends {:.3g} m from waypoint {}; "
                  "obstacles are inflated by {:.3g} m",
                  options.trees, options.iterations, way.left, way.goals + 1, task.inflation));
}

}  // namespace

Plan PlanWith(const RrtPlannerOptions& options, const PlanRequest& request) {
  if (Plan refused = route::CheckRoute(request); !refused.ok()) {
    return refused;
  }
  TRACKBED_CHECK(options.trees > 0, "{} trees", options.trees);
  const Task task = TaskOf(options, request);
  if (!IsFree(task, {0.0, 0.0}, task.lead)) {
    return route::Refused(
        PlanStatus::kStartBlocked,
        fmt::format("an obstacle is nearer than {:.3g} m to the first {:.3g} m straight on",
                    task.inflation, task.lead.x()));
  }
  const Tangents tangents(request.vehicle, std::min(options.min_speed, request.speed.speed));
  std::optional<Try> best;
  nlohmann::json trees = nlohmann::json::array();
  int chosen = 0;
  for (int i = 0; i < options.trees; ++i) {
    Try next;
    next.way = GrowWay(options, task, tangents, request.start,
                       request.seed + (static_cast<std::uint64_t>(i) << 32U));
    if (next.way.status != RrtStatus::kReached) {
      next.plan = RefusedAs(next.way, options, task);
    } else {
      next.plan = route::AlongPolyline({}, request, InWorld(request.start, next.way.points),
                                       options.corners, options.safe_distance, options.min_speed);
      next.score = ScoreWay(InPieces(next.way.points), {0.0, 0.0}, task.obstacles, task.inflation,
                            task.wind, {});
    }
    trees.push_back({{"status", ToString(next.plan.status)},
                     {"reason", next.plan.reason},
                     {"length_m", next.score.length},
                     {"wind_m", next.score.wind},
                     {"total_m", next.score.total}});
    const bool hopeless = next.way.status == RrtStatus::kGoalBlocked;
    if (!best || IsBetterTry(next, *best)) {
      best = std::move(next);
      chosen = i;
    }
    if (hopeless) {
      break;
    }
  }
  Plan plan = std::move(best->plan);
  plan.diagnostics["legs"] = std::move(best->way.legs);
  plan.diagnostics["trees"] = std::move(trees);
  plan.diagnostics["chosen"] = chosen;
  if (plan.ok()) {
    plan.tree = std::move(best->way.tree);
  }
  return plan;
}

}  // namespace trackbed
