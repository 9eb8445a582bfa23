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

/// The pose of a moving obstacle at one time.
struct TimedPose {
  double time = 0.0;  ///< Time [s].
  Pose2 pose;         ///< Pose of the middle of the obstacle's footprint.
};

/// An obstacle: a box on the ground, which is static, moves at a constant velocity without
/// rotation, or moves through given poses.
struct Obstacle {
  OrientedBox footprint;  ///< Footprint of the box at time 0.
  double height = 1.0;    ///< Height of the box [m], > 0.
  /// Time from which planners know the obstacle [s]. The obstacle exists from the start of the run;
  /// if neither `known_from_time` nor `known_from_range` is set, planners also know the obstacle
  /// from the start.
  std::optional<double> known_from_time;  ///< Time [s].
  /// Distance from the car's footprint within which planners learn of the obstacle [m].
  std::optional<double> known_from_range;
  /// Constant velocity of the box in the world [m/s]; zero if the box moves through poses.
  Vec2 velocity = Vec2::Zero();
  /// Poses through which the box moves, with increasing times; empty, or at least two. The box
  /// moves from each pose to the next at a constant velocity and a constant yaw rate, and turns by
  /// less than pi. Before its first and after its last pose, the box keeps the velocity of the
  /// adjacent motion between two poses and does not rotate. If the box moves through poses,
  /// `footprint` has the pose of the box at time 0.
  std::vector<TimedPose> motion{};
  /// Time after which the obstacle no longer exists [s]; its box is then moved 1000 km away.
  /// Default: never.
  std::optional<double> until{};

  [[nodiscard]] bool moves() const { return !motion.empty() || until || velocity != Vec2::Zero(); }
};

/// The look of the road that is drawn along the plan in videos and other pictures. The drawn road
/// has no effect on the run.
struct RoadLook {
  double width = 7.0;  ///< Width of the road between the edge lines [m]; 0: no road is drawn.
  int lanes = 2;       ///< Number of lanes; all lanes have equal width.
};

/// A road network that is read from a file.
struct RoadNetworkSpec {
  /// Name of the OpenDRIVE file, relative to the scenario file.
  std::string file;
  /// Content of the OpenDRIVE file; null if the file has not been read.
  std::shared_ptr<const OpenDriveFile> data{};
};

/// The world in which a car drives: road, ground, wind and obstacles.
struct World {
  /// Factor by which the world's roads scale the tyres' friction coefficient, for both tyre models.
  double friction = 1.0;
  /// Areas whose friction factor differs from `friction`. Where friction patches overlap, the last
  /// patch in the list applies.
  std::vector<FrictionPatch> friction_patches{};
  Ground ground{};
  Wind wind{};
  std::vector<Obstacle> obstacles;
  /// The road that is drawn in pictures; if nullopt, a default road is drawn for planners that
  /// follow roads (analysis/road_look.h).
  std::optional<RoadLook> road{};
  /// Grid map whose walls are obstacles from the start of the run, in addition to `obstacles`.
  std::optional<MapSpec> map{};
  std::optional<RoadNetworkSpec> road_network{};
};

/// Whether the world has obstacles or a map with walls.
bool HasObstacles(const World& world);

/// Returns the walls of the world's map; empty if the world has no map.
const std::vector<OrientedBox>& MapWalls(const World& world);

/// Returns the road's factor on the tyres' friction coefficient at a point. RoadFactor returns the
/// factor of the last friction patch in the list that contains the point, or `friction` if no patch
/// contains the point. The run time of RoadFactor is proportional to the number of friction
/// patches. Throws PreconditionError if the point is not finite.
double RoadFactor(const World& world, const Vec2& point_W);

/// Returns the factor of RoadFactor above, for a given `friction` and given `patches`.
double RoadFactor(double friction, const std::vector<FrictionPatch>& patches, const Vec2& point_W);

/// Return the height and the normal of the ground, and the wind, at a point of the world (road.h,
/// wind.h).
double GroundHeight(const World& world, const Vec2& point_W);
Eigen::Vector3d GroundNormal(const World& world, const Vec2& point_W);
Vec2 WindAt(const World& world, const Vec2& point_W, double time);

/// Returns the footprint of a car whose rear-axle center is at `pose`.
OrientedBox FootprintAt(const VehicleParams& vehicle, const Pose2& pose);

/// The motion of an obstacle at one time.
struct ObstacleMotion {
  /// Displacement from the center of the obstacle's footprint at time 0, and rotation since then.
  Pose2 displacement;
  Vec2 velocity = Vec2::Zero();  ///< Velocity of the obstacle in the world [m/s].
  double yaw_rate = 0.0;         ///< Yaw rate [rad/s].
};

/// Returns the motion of an obstacle at `time` [s]. The run time of MotionAt is logarithmic in the
/// number of the obstacle's poses.
ObstacleMotion MotionAt(const Obstacle& obstacle, double time);

/// Returns the footprint of an obstacle at `time` [s].
OrientedBox FootprintAt(const Obstacle& obstacle, double time);

/// Whether planners that do not know the obstacle yet learn of the obstacle at `time` [s], when the
/// car has the given footprint.
bool IsKnown(const Obstacle& obstacle, double time, const OrientedBox& footprint);

/// Returns the shortest distance from the car's footprint to any obstacle or wall at `time` [m].
/// Returns 0 if the car touches or overlaps an obstacle or wall, which counts as a collision on
/// every plant. Returns nullopt if the world has no obstacles. The run time of Clearance is
/// proportional to the number of obstacles and nearby walls.
std::optional<double> Clearance(const World& world, const VehicleParams& vehicle, const Pose2& pose,
                                double time);

/// The pose and clearance of a car at one time.
struct ClearanceSample {
  Pose2 pose;
  double time = 0.0;       ///< Time [s].
  double clearance = 0.0;  ///< Clearance of the car at `time`, as returned by Clearance() [m].
};

/// The minimum clearance of a car between two times, and the time of the minimum.
struct ClosestApproach {
  double clearance = 0.0;  ///< Minimum clearance of the car [m]; 0 in a collision.
  double time = 0.0;       ///< Time at which the clearance is minimal [s].
};

/// Returns the minimum clearance of a car between two samples. ApproachBetween assumes that between
/// the samples the car moves on a straight line and turns at a constant rate, by far less than a
/// full turn. ApproachBetween includes the motion of obstacles between the samples.
///
/// Guarantees: every contact deeper than 1 mm is detected. The returned minimum clearance exceeds
/// the true minimum by at most 5 mm or a hundredth of the clearance. If the car and the obstacles
/// are further apart than they move between the samples, the run time is negligible. For a car
/// closer to obstacles, ApproachBetween calls Clearance() several times, at most 10^5 times. For a
/// motion over kilometers, 10^5 calls of Clearance() may not suffice. After 10^5 calls of
/// Clearance(), the search for the minimum ends, and the later part of the motion is not searched.
/// Throws InternalError if the world has no obstacles. Throws PreconditionError if a sample is not
/// finite.
ClosestApproach ApproachBetween(const World& world, const VehicleParams& vehicle,
                                const ClearanceSample& from, const ClearanceSample& to);

}  // namespace trackbed
