#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/world/map_obstacles.h"
#include "trackbed/world/road.h"
#include "trackbed/world/wind.h"

namespace trackbed {

struct OpenDriveFile;

/// A box on the ground, static or translating.
struct Obstacle {
  OrientedBox footprint;  ///< at time 0
  double height = 1.0;    ///< [m], > 0
  /// When planners learn of it; the obstacle exists before that. If neither is set: from the start.
  std::optional<double> known_from_time;   ///< [s]
  std::optional<double> known_from_range;  ///< when the car's footprint is this close [m]
  Vec2 velocity = Vec2::Zero();            ///< in the world, constant [m/s]

  [[nodiscard]] bool moves() const { return velocity != Vec2::Zero(); }
};

/// A road drawn along the plan in pictures. It does not affect the run.
struct RoadLook {
  double width = 7.0;  ///< between the edge lines [m]; 0: no road
  int lanes = 2;       ///< of equal width
};

/// A road network from a file.
struct RoadNetworkSpec {
  std::string file;                             ///< OpenDRIVE; relative to the scenario file
  std::shared_ptr<const OpenDriveFile> data{};  ///< road_network/open_drive.h; null: not read
};

/// The environment of a car.
struct World {
  double friction = 1.0;  ///< factor on the tyres' friction coefficient, for both tyre laws
  std::vector<FrictionPatch>
      friction_patches{};  ///< areas of different friction; later ones override earlier ones
  Ground ground{};
  Wind wind{};
  std::vector<Obstacle> obstacles;
  /// None: a default road for planners that follow roads (analysis/road_look.h).
  std::optional<RoadLook> road{};
  std::optional<MapSpec> map{};  ///< its walls exist from the start, in addition to `obstacles`
  std::optional<RoadNetworkSpec> road_network{};
};

/// Whether there are obstacles or walls of a map.
bool HasObstacles(const World& world);

/// The walls of the world's map; empty without a map.
const std::vector<OrientedBox>& MapWalls(const World& world);

/// The road's factor on the tyres' friction coefficient at a point: that of the last patch in the
/// list that contains it, else `friction`. Cost O(patches). PreconditionError for a point that is
/// not finite.
double RoadFactor(const World& world, const Vec2& point_W);

/// As above, from friction and patches.
double RoadFactor(double friction, const std::vector<FrictionPatch>& patches, const Vec2& point_W);

/// Height, normal and wind of the world at a point; see road.h and wind.h.
double GroundHeight(const World& world, const Vec2& point_W);
Eigen::Vector3d GroundNormal(const World& world, const Vec2& point_W);
Vec2 WindAt(const World& world, const Vec2& point_W, double time);

/// The car's footprint when its rear-axle center is at `pose`.
OrientedBox FootprintAt(const VehicleParams& vehicle, const Pose2& pose);

/// The footprint of an obstacle at `time` [s].
OrientedBox FootprintAt(const Obstacle& obstacle, double time);

/// Whether planners that do not know the obstacle yet learn of it now.
bool IsKnown(const Obstacle& obstacle, double time, const OrientedBox& footprint);

/// Shortest distance from the car's footprint to any obstacle or wall at `time` [m]; 0 when they
/// touch or overlap, which counts as a collision on every plant. None without obstacles. Cost
/// O(obstacles), and that of nearby walls.
std::optional<double> Clearance(const World& world, const VehicleParams& vehicle, const Pose2& pose,
                                double time);

/// The clearance of a car at one moment.
struct ClearanceSample {
  Pose2 pose;
  double time = 0.0;       ///< [s]
  double clearance = 0.0;  ///< Clearance() there [m]
};

/// The minimum clearance between two moments and its time.
struct ClosestApproach {
  double clearance = 0.0;  ///< [m]; 0 in a collision
  double time = 0.0;       ///< [s]
};

/// The minimum clearance of the footprint between two samples, for a car that moves on a straight
/// line and turns at a constant rate, by far less than a full turn. Moving obstacles move too.
///
/// Guarantees: detects every contact deeper than 1 mm; the clearance is at most 5 mm, or a
/// hundredth of it, above the smallest one. Cost: none if the samples are further from every
/// obstacle than anything moves between them, else some Clearance() calls, 10^5 at most: a motion
/// over kilometers may need more, and is then only searched in part. InternalError without
/// obstacles, PreconditionError for samples that are not finite.
ClosestApproach ApproachBetween(const World& world, const VehicleParams& vehicle,
                                const ClearanceSample& from, const ClearanceSample& to);

}  // namespace trackbed
