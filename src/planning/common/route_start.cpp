#include "trackbed/planning/common/route_start.h"

#include <cmath>

namespace trackbed {

Pose2 StartOfRoute(const std::vector<Vec2>& waypoints) {
  if (waypoints.empty()) {
    return {};
  }
  const Vec2& first = waypoints.front();
  if (waypoints.size() == 1) {
    return {first.x(), first.y(), 0.0};
  }
  const Vec2 leg = waypoints[1] - first;
  return {first.x(), first.y(), std::atan2(leg.y(), leg.x())};
}

}  // namespace trackbed
