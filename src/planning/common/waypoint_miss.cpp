#include "trackbed/planning/common/waypoint_miss.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace trackbed {

std::optional<WaypointMiss> LargestWaypointMiss(const Path& path,
                                                const std::vector<Vec2>& waypoints) {
  std::optional<WaypointMiss> largest;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const Vec2& at = waypoints[i];
    const double s = path.Project({at.x(), at.y(), 0.0}, {0.0, path.length()}).s;
    const double distance = (path.At(s).pose.position() - at).norm();
    if (!largest || distance > largest->distance + kSameMiss) {
      largest = WaypointMiss{i, at, distance, s};
    }
  }
  return largest;
}

std::string DescribeWaypoint(std::size_t waypoint, const Vec2& at) {
  return fmt::format("waypoint {} at ({:.10g}, {:.10g})", waypoint, at.x(), at.y());
}

std::string RemedyForMiss(double distance) {
  // Unit of the last digit if the distance is written with three digits; at least a millimeter.
  const double digit = std::pow(10.0, std::max(std::floor(std::log10(distance)) - 2.0, -3.0));
  return fmt::format("set plan.max_waypoint_miss to at least {:.10g}, or move the waypoint",
                     digit * (std::floor(distance / digit) + 1.0));
}

}  // namespace trackbed
