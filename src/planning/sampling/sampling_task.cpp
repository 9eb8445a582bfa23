#include "src/planning/sampling/sampling_task.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/planning/sampling/prune_waypoints.h"
#include "trackbed/geometry/box_index.h"
#include "trackbed/planning/common/route.h"

namespace trackbed {
namespace {

Pose2 InFrame(const Pose2& X_WF, const Pose2& X_WA) {
  const Vec2 position = ToLocal(X_WF, X_WA.position());
  return {position.x(), position.y(), X_WA.yaw - X_WF.yaw};
}

Vec2 DirectionInFrame(const Pose2& X_WF, const Vec2& vector) {
  return ToLocal({0.0, 0.0, X_WF.yaw}, vector);
}

}  // namespace

double StraightStart(double lead_in, const PlanRequest& request) {
  return std::min(lead_in, 0.5 * ToLocal(request.start, request.waypoints.at(1)).norm());
}

SamplingTask MakeSamplingTask(const SamplingTaskOptions& options, const PlanRequest& request) {
  const Pose2& frame = request.start;
  SamplingTask task;
  for (std::size_t i = 1; i < request.waypoints.size(); ++i) {
    task.goals.push_back(ToLocal(frame, request.waypoints[i]));
  }
  task.lead.x() = StraightStart(options.lead_in, request);
  for (const OrientedBox& box : request.obstacles) {
    task.obstacles.push_back({InFrame(frame, box.center), box.length, box.width});
  }
  const double inflation = 0.5 * request.vehicle.width + options.safe_distance +
                           (options.corners == Corners::kRound ? options.corner_room : 0.0);
  const CollisionChecker clear = route::CheckerFromStart(request, options.safe_distance);
  std::vector<Vec2> ends{task.lead};
  for (const Vec2& goal : route::GoalsOutsideObstacles(request, clear)) {
    ends.push_back(ToLocal(frame, goal));
  }
  task.inflation = InflationAt(ends, task.obstacles, inflation);
  task.lead_inflation = InflationAt({{0.0, 0.0}}, task.obstacles, inflation);
  task.goal_distance = clear.inner_radius() + options.safe_distance;
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

Plan CheckLeadIn(const SamplingTask& task, const PlanRequest& request, double safe_distance) {
  if (Plan refused = route::CheckStart(request, safe_distance); !refused.ok()) {
    return refused;
  }
  const double length = task.lead.x();
  if (BoxIndex(task.obstacles).KeepsFrom({0.0, 0.0}, task.lead, task.lead_inflation) ||
      route::CheckerFromStart(request, safe_distance)
          .IsFree(request.start, Segment{.length = length})) {
    return {};
  }
  return route::Refused(
      PlanStatus::kStartBlocked,
      fmt::format("an obstacle is closer than {:.3g} m to the first {:.3g} m of straight path",
                  task.lead_inflation.most, length));
}

Plan GoalBlocked(const SamplingTask& task, std::size_t waypoint) {
  return route::Refused(PlanStatus::kGoalBlocked,
                        fmt::format("an obstacle is closer than {:.3g} m to waypoint {}",
                                    task.goal_distance, waypoint));
}

CornerTangents::CornerTangents(const VehicleParams& vehicle, double speed) {
  for (std::size_t i = 1; i < kCount; ++i) {
    lengths_[i] =
        CornerAt(vehicle, static_cast<double>(i) * kStep, speed, 1.0 / vehicle.min_turning_radius())
            .tangent_length;
  }
}

double CornerTangents::operator()(double turn) const {
  const auto next = static_cast<std::size_t>(std::ceil(turn / kStep));
  return next < kCount ? lengths_[next] : std::numeric_limits<double>::infinity();
}

void AddPruned(const SamplingTask& task, const CornerTangents& tangents, double corner_cost,
               const std::vector<Vec2>& path, bool is_last, std::vector<Vec2>& points) {
  const std::size_t before = points.size();
  const std::vector<Vec2> few =
      PruneWaypoints(path, {.before = before > 1 ? std::optional(points[before - 2]) : std::nullopt,
                            .first_leg = before <= 2,
                            .last_leg = is_last,
                            .obstacles = task.obstacles,
                            .inflation = task.inflation,
                            .wind = task.wind,
                            .corner_cost = corner_cost,
                            .tangent = tangents});
  points.insert(points.end(), few.begin() + 1, few.end());
}

std::vector<Vec2> InWorld(const Pose2& frame, std::vector<Vec2> points) {
  for (Vec2& point : points) {
    point = ToWorld(frame, point);
  }
  return points;
}

}  // namespace trackbed
