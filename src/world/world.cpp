#include "trackbed/world/world.h"

#include <algorithm>

namespace trackbed {

OrientedBox OutlineAt(const VehicleParams& vehicle, const Pose2& pose) {
  const Vec2 middle = ToWorld(pose, {0.5 * vehicle.length - vehicle.rear_overhang, 0.0});
  return {{middle.x(), middle.y(), pose.yaw}, vehicle.length, vehicle.width};
}

bool IsKnown(const Obstacle& obstacle, double time, const OrientedBox& outline) {
  if (obstacle.known_from_range) {
    return Distance(outline, obstacle.footprint) <= *obstacle.known_from_range;
  }
  return time >= obstacle.known_from_time.value_or(0.0);
}

std::optional<double> Clearance(const World& world, const VehicleParams& vehicle,
                                const Pose2& pose) {
  if (world.obstacles.empty()) {
    return std::nullopt;
  }
  const OrientedBox outline = OutlineAt(vehicle, pose);
  double nearest = Distance(outline, world.obstacles.front().footprint);
  for (const Obstacle& obstacle : world.obstacles) {
    nearest = std::min(nearest, Distance(outline, obstacle.footprint));
  }
  return nearest;
}

}  // namespace trackbed
