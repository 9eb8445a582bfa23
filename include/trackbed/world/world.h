#pragma once

#include <optional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/world/road.h"
#include "trackbed/world/wind.h"

namespace trackbed {

/// A box that stands on the ground, or moves along it without turning.
struct Obstacle {
  OrientedBox footprint;  ///< at time 0
  double height = 1.0;    ///< [m], > 0
  /// When planners learn of it; it stands there before, too. Neither: they know from the start.
  std::optional<double> known_from_time;   ///< [s]
  std::optional<double> known_from_range;  ///< once the car's outline is this close [m]
  Vec2 velocity = Vec2::Zero();            ///< in the world, always the same [m/s]

  [[nodiscard]] bool moves() const { return velocity != Vec2::Zero(); }
};

/// What a car drives in.
struct World {
  double friction = 1.0;  ///< factor on the tyres' own friction coefficient, both tyre laws
  std::vector<FrictionPatch> friction_patches{};  ///< where it is another; later ones lie on top
  Ground ground{};
  Wind wind{};
  std::vector<Obstacle> obstacles;
};

/// The road's factor on the tyres' friction coefficient at a point: that of the last patch in the
/// list that contains it, else `friction`. Cost O(patches).
double RoadFactor(const World& world, const Vec2& point_W);

/// The same of its parts.
double RoadFactor(double friction, const std::vector<FrictionPatch>& patches, const Vec2& point_W);

/// Of the world's ground and wind; see road.h and wind.h.
double GroundHeight(const World& world, const Vec2& point_W);
Eigen::Vector3d GroundNormal(const World& world, const Vec2& point_W);
Vec2 WindAt(const World& world, const Vec2& point_W, double time);

/// The car's outline on the ground when its rear-axle center is at `pose`.
OrientedBox OutlineAt(const VehicleParams& vehicle, const Pose2& pose);

/// Where an obstacle is at `time` [s].
OrientedBox FootprintAt(const Obstacle& obstacle, double time);

/// Whether planners that have not known of the obstacle yet learn of it now.
bool IsKnown(const Obstacle& obstacle, double time, const OrientedBox& outline);

/// Shortest distance from the car's outline to any obstacle, where that is at `time` [m]; 0 when
/// they touch or overlap, which is what counts as a collision on every plant. None without
/// obstacles. Cost O(obstacles).
std::optional<double> Clearance(const World& world, const VehicleParams& vehicle, const Pose2& pose,
                                double time);

/// A car at one moment, and how far it was from the nearest obstacle.
struct ClearanceSample {
  Pose2 pose;
  double time = 0.0;       ///< [s]
  double clearance = 0.0;  ///< Clearance() there [m]
};

/// The smallest clearance between two moments, and when.
struct ClosestApproach {
  double clearance = 0.0;  ///< [m]; 0 in a collision
  double time = 0.0;       ///< [s]
};

/// How near the outline comes to an obstacle while the car moves from one sample to the next, which
/// it does on a straight line and turning evenly: far less than a turn apart. Obstacles move too.
///
/// Guarantees: no contact deeper than 1 mm is missed; the clearance is at most 5 mm, or a hundredth
/// of it, above the smallest one. Cost: none when the samples are further from every obstacle than
/// anything moves in between, else some Clearance() calls. InternalError without obstacles.
ClosestApproach ApproachBetween(const World& world, const VehicleParams& vehicle,
                                const ClearanceSample& from, const ClearanceSample& to);

}  // namespace trackbed
