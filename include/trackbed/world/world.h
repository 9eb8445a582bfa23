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
  OrientedBox footprint;  ///< Footprint at time 0.
  double height = 1.0;    ///< Height [m], > 0.
  /// Time or range at which planners learn of the obstacle, although the obstacle exists from the
  /// start. If both are empty, planners know the obstacle from the start.
  std::optional<double> known_from_time;   ///< Time [s].
  std::optional<double> known_from_range;  ///< Distance from the car's footprint [m].
  Vec2 velocity = Vec2::Zero();            ///< Constant velocity in the world [m/s].

  [[nodiscard]] bool moves() const { return velocity != Vec2::Zero(); }
};

/// A road drawn along the plan in pictures. The drawn road does not affect the run.
struct RoadLook {
  double width = 7.0;  ///< Width between the edge lines [m]; 0: no road.
  int lanes = 2;       ///< Number of lanes of equal width.
};

/// A road network from a file.
struct RoadNetworkSpec {
  std::string file;                             ///< OpenDRIVE file, relative to the scenario file.
  std::shared_ptr<const OpenDriveFile> data{};  ///< Content of the file; null: not read.
};

/// The environment of a car.
struct World {
  double friction = 1.0;  ///< Factor on the tyres' friction coefficient, for both tyre laws.
  /// Areas of different friction. Later areas override earlier ones.
  std::vector<FrictionPatch> friction_patches{};
  Ground ground{};
  Wind wind{};
  std::vector<Obstacle> obstacles;
  /// The road in pictures. Nullopt: a default road for planners that follow roads
  /// (analysis/road_look.h).
  std::optional<RoadLook> road{};
  /// Map whose walls exist from the start, in addition to `obstacles`.
  std::optional<MapSpec> map{};
  std::optional<RoadNetworkSpec> road_network{};
};

/// Whether there are obstacles or walls of a map.
bool HasObstacles(const World& world);

/// The walls of the world's map; empty without a map.
const std::vector<OrientedBox>& MapWalls(const World& world);

/// Returns the road's factor on the tyres' friction coefficient at a point: the factor of the last
/// patch in the list that contains the point, else `friction`. Cost O(patches). PreconditionError
/// for a point that is not finite.
double RoadFactor(const World& world, const Vec2& point_W);

/// As RoadFactor above, for a given friction and given patches.
double RoadFactor(double friction, const std::vector<FrictionPatch>& patches, const Vec2& point_W);

/// Height, normal and wind of the world at a point (road.h, wind.h).
double GroundHeight(const World& world, const Vec2& point_W);
Eigen::Vector3d GroundNormal(const World& world, const Vec2& point_W);
Vec2 WindAt(const World& world, const Vec2& point_W, double time);

/// The car's footprint if its rear-axle center is at `pose`.
OrientedBox FootprintAt(const VehicleParams& vehicle, const Pose2& pose);

/// The footprint of an obstacle at `time` [s].
OrientedBox FootprintAt(const Obstacle& obstacle, double time);

/// Whether planners learn of the obstacle at `time` [s], when the car has the given footprint, if
/// they did not know the obstacle before.
bool IsKnown(const Obstacle& obstacle, double time, const OrientedBox& footprint);

/// Shortest distance from the car's footprint to any obstacle or wall at `time` [m]; 0 if they
/// touch or overlap, which is a collision on every plant. Returns nullopt if the world has no
/// obstacles. Cost O(obstacles), and that of nearby walls.
std::optional<double> Clearance(const World& world, const VehicleParams& vehicle, const Pose2& pose,
                                double time);

/// The clearance of a car at one moment.
struct ClearanceSample {
  Pose2 pose;
  double time = 0.0;       ///< Time [s].
  double clearance = 0.0;  ///< Value of Clearance() at `time` [m].
};

/// The minimum clearance between two moments and its time.
struct ClosestApproach {
  double clearance = 0.0;  ///< Minimum clearance [m]; 0 in a collision.
  double time = 0.0;       ///< Time of the minimum clearance [s].
};

/// The minimum clearance of the footprint between two samples. The car moves on a straight line and
/// turns at a constant rate, by far less than a full turn. Moving obstacles move between the
/// samples.
///
/// Guarantees: every contact deeper than 1 mm is detected. The returned clearance exceeds the true
/// minimum by at most 5 mm, or a hundredth of the clearance. Cost: none if car and obstacles are
/// further apart than they move between the samples. Otherwise, the cost is some calls of
/// Clearance(), at most 10^5. A motion over kilometers may need more calls; only a part of this
/// motion is then searched. InternalError without obstacles, PreconditionError for samples that are
/// not finite.
ClosestApproach ApproachBetween(const World& world, const VehicleParams& vehicle,
                                const ClearanceSample& from, const ClearanceSample& to);

}  // namespace trackbed
