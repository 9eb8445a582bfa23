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

std::vector<std::vector<Vec2>> DeparturesToNearWaypoint(const PlanRequest& request) {
  std::vector<std::vector<Vec2>> departures = DeparturePolylines(request);
  double longest = 0.0;
  for (const std::vector<Vec2>& points : departures) {
    longest = std::max(longest, ToLocal(request.start, points[1]).x());
  }
  const double ahead = ToLocal(request.start, request.waypoints.at(1)).x();
  return ahead < longest ? departures : std::vector<std::vector<Vec2>>{};
}

SamplingTask MakeSamplingTask(const SamplingTaskOptions& options, const PlanRequest& request) {
  const Pose2& frame = request.start;
  SamplingTask task;
  for (std::size_t i = 1; i < request.waypoints.size(); ++i) {
    task.goals.push_back(ToLocal(frame, request.waypoints[i]));
  }
  task.departure.emplace_back(0.0, 0.0);
  if (const double straight = StraightStart(options.lead_in, request);
      options.departure.empty() && straight > 0.0) {
    task.departure.emplace_back(straight, 0.0);
  }
  for (std::size_t i = 1; i < options.departure.size(); ++i) {
    task.departure.push_back(ToLocal(frame, options.departure[i]));
  }
  for (const OrientedBox& box : request.obstacles) {
    task.obstacles.push_back({InFrame(frame, box.center), box.length, box.width});
  }
  const double inflation = 0.5 * request.vehicle.width + options.safe_distance +
                           (options.corners == Corners::kRound ? options.corner_room : 0.0);
  const CollisionChecker clear = route::CheckerFromStart(request, options.safe_distance);
  std::vector<Vec2> ends{task.departure.back()};
  for (const Vec2& goal : route::GoalsOutsideObstacles(request, clear)) {
    ends.push_back(ToLocal(frame, goal));
  }
  task.inflation = InflationAt(ends, task.obstacles, inflation);
  task.lead_inflation = InflationAt({{0.0, 0.0}}, task.obstacles, inflation);
  std::vector<Vec2> points = task.goals;
  const std::ptrdiff_t after_start = task.departure.size() > 1 ? 1 : 0;
  points.insert(points.end(), task.departure.begin() + after_start, task.departure.end());
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
  const BoxIndex obstacles(task.obstacles);
  const std::vector<Vec2>& points = task.departure;
  double length = 0.0;
  bool is_free = true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2& from = points[i > 0 ? i - 1 : 0];
    length += (points[i] - from).norm();
    is_free = is_free && obstacles.KeepsFrom(from, points[i], task.lead_inflation);
  }
  const bool is_straight = points.size() <= 2;
  if (is_free || (is_straight && route::CheckerFromStart(request, safe_distance)
                                     .IsFree(request.start, Segment{.length = length}))) {
    return {};
  }
  return route::Refused(
      PlanStatus::kStartBlocked,
      fmt::format("an obstacle is closer than {:.3g} m to the first {:.3g} m of straight path",
                  task.lead_inflation.most, length));
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
  const PruningProblem problem{
      .before = before > 1 ? std::optional(points[before - 2]) : std::nullopt,
      .first_leg = before <= 2,
      .last_leg = is_last,
      .obstacles = task.obstacles,
      .inflation = task.inflation,
      .wind = task.wind,
      .corner_cost = corner_cost,
      .tangent = tangents};
  const std::vector<Vec2> few = JoinCloseCorners(PruneWaypoints(path, problem), problem);
  points.insert(points.end(), few.begin() + 1, few.end());
}

std::vector<Vec2> InWorld(const Pose2& frame, std::vector<Vec2> points) {
  for (Vec2& point : points) {
    point = ToWorld(frame, point);
  }
  return points;
}

}  // namespace trackbed
