#include "trackbed/world/world.h"

#include <algorithm>
#include <limits>

namespace trackbed {

double RoadFactor(const World& world, const Vec2& point_W) {
  const auto& patches = world.friction_patches;
  const auto on_top =
      std::find_if(patches.rbegin(), patches.rend(),
                   [&](const FrictionPatch& patch) { return Contains(patch.area, point_W); });
  return on_top == patches.rend() ? world.friction : on_top->friction;
}

double GroundHeight(const World& world, const Vec2& point_W) {
  return GroundHeight(world.ground, point_W);
}

Eigen::Vector3d GroundNormal(const World& world, const Vec2& point_W) {
  return GroundNormal(world.ground, point_W);
}

Vec2 WindAt(const World& world, const Vec2& point_W, double time) {
  return WindAt(world.wind, point_W, time);
}

OrientedBox OutlineAt(const VehicleParams& vehicle, const Pose2& pose) {
  const Vec2 middle = ToWorld(pose, {0.5 * vehicle.length - vehicle.rear_overhang, 0.0});
  return {{middle.x(), middle.y(), pose.yaw}, vehicle.length, vehicle.width};
}

OrientedBox FootprintAt(const Obstacle& obstacle, double time) {
  return MovingBox{obstacle.footprint, obstacle.velocity}.At(time);
}

bool IsKnown(const Obstacle& obstacle, double time, const OrientedBox& outline) {
  if (obstacle.known_from_range) {
    return Distance(outline, FootprintAt(obstacle, time)) <= *obstacle.known_from_range;
  }
  return time >= obstacle.known_from_time.value_or(0.0);
}

std::optional<double> Clearance(const World& world, const VehicleParams& vehicle, const Pose2& pose,
                                double time) {
  if (world.obstacles.empty()) {
    return std::nullopt;
  }
  const OrientedBox outline = OutlineAt(vehicle, pose);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : world.obstacles) {
    nearest = std::min(nearest, Distance(outline, FootprintAt(obstacle, time)));
  }
  return nearest;
}

}  // namespace trackbed
