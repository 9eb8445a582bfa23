#include "src/analysis/waypoint_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "src/analysis/peaks.h"
#include "trackbed/planning/common/waypoint_miss.h"

namespace trackbed {
namespace {

/// The point of the driven path that is nearest to a waypoint.
struct NearestPoint {
  double distance = std::numeric_limits<double>::infinity();  // Distance to the waypoint [m].
  double s = 0.0;                                             // Station [m].
  double t = 0.0;                                             // Time [s].
};

NearestPoint FindNearest(const RunLog& log, const Vec2& waypoint) {
  NearestPoint nearest;
  const LogRow* before = &log.rows.front();
  for (const LogRow& row : log.rows) {
    if (log.contact_time && row.state.time > *log.contact_time && before != &row) {
      break;  // from this row on, an obstacle pushes the car
    }
    const Vec2 from = before->state.pose.position();
    const Vec2 along = row.state.pose.position() - from;
    const double squares = along.squaredNorm();
    const double share =
        squares > 0.0 ? std::clamp((waypoint - from).dot(along) / squares, 0.0, 1.0) : 0.0;
    const double distance = (from + share * along - waypoint).norm();
    if (distance < nearest.distance) {
      nearest = {distance, std::lerp(RowStation(*before), RowStation(row), share),
                 std::lerp(before->state.time, row.state.time, share)};
    }
    before = &row;
  }
  return nearest;
}

}  // namespace

std::optional<WaypointMissMetrics> MeasureWaypointMiss(const RunLog& log, const Plan& plan) {
  const auto planned = LargestWaypointMiss(plan.reference.path, plan.waypoints);
  if (!planned) {
    return std::nullopt;
  }
  WaypointMissMetrics metrics{.planned = planned->distance};
  for (std::size_t i = 1; i < plan.waypoints.size(); ++i) {
    const NearestPoint nearest = FindNearest(log, plan.waypoints[i]);
    if (i == 1 || nearest.distance > metrics.max + kSameMiss) {
      metrics.max = nearest.distance;
      metrics.waypoint = static_cast<int>(i);
      metrics.max_s = nearest.s;
      metrics.max_t = nearest.t;
    }
  }
  return metrics;
}

}  // namespace trackbed
