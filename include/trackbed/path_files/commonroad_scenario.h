#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path_files/drawn_lanes.h"

/// Reads scenarios of CommonRoad: roads as lanelets, obstacles with their motions, and a planning
/// problem (Althoff, Koschi and Manzinger 2017).
namespace trackbed {

/// An obstacle of a CommonRoad scenario.
struct CommonRoadObstacle {
  /// Obstacle's footprint at its first pose, or where it stands.
  OrientedBox box;
  /// Times [s] and poses of the box's center along its motion, with increasing times; empty if the
  /// obstacle stands. An obstacle that moves has at least two poses, and leaves the road at the
  /// last pose.
  std::vector<std::pair<double, Pose2>> poses;
};

/// A region of the plane. The region is a convex polygon with counter-clockwise corners, or a disc.
struct CommonRoadRegion {
  std::vector<Vec2> corners;  ///< Corners of the region [m]; empty for a disc.
  Vec2 center{0.0, 0.0};      ///< Center of the disc [m].
  double radius = 0.0;        ///< Radius of the disc [m].

  /// Whether the region contains the point.
  [[nodiscard]] bool Contains(const Vec2& point) const;
};

/// The goal of a planning problem: conditions for the car's center at one time.
struct CommonRoadGoal {
  /// The car's center must be in one of these regions; if the list is empty, any position is
  /// allowed.
  std::vector<CommonRoadRegion> regions;
  std::pair<double, double> time{0.0, 0.0};        ///< Earliest and latest time at the goal [s].
  std::optional<std::pair<double, double>> speed;  ///< Lowest and highest speed at the goal [m/s].
  /// Bounds of the heading at the goal [rad].
  std::optional<std::pair<double, double>> orientation;
};

/// A CommonRoad scenario with a route that solves its planning problem if the road is free.
struct CommonRoadScenario {
  std::string name;  ///< The benchmark ID, or the name of the file without its ending.
  std::vector<CommonRoadObstacle> obstacles;
  Pose2 start;               ///< Pose of the car's center at time 0.
  double start_speed = 0.0;  ///< Speed of the car at time 0 [m/s], >= 0.
  CommonRoadGoal goal;
  /// Points for the car's center, about 1 m apart [m]. The points of the route lead from the start
  /// onto the lanelets' centers, and along the shortest sequence of lanelets to the goal. Beyond
  /// the goal, the points of the route continue far enough for a car to stop.
  std::vector<Vec2> route;
  /// Speed at which a car on the route reaches the goal in time [m/s], >= 0.1; of all such speeds,
  /// the one nearest to the initial speed.
  double speed = 0.0;
  /// Heading of the route at the goal, continued from the start's heading without jumps [rad].
  double goal_yaw = 0.0;
  /// Smallest distances from the route to the edge of the road, to the left and to the right [m],
  /// at most 8 m. For the distances to the road's edges, lanelets of both directions belong to the
  /// road. The distances to the road's edges are measured at the route's points up to the goal.
  double room_left = 0.0;
  double room_right = 0.0;
  DrawnLanes lanes;                ///< Lanelets within 150 m of the route.
  std::vector<std::string> notes;  ///< Parts of the file that were left out or approximated.
};

/// Acceleration and deceleration of the car, with which the route's speed and length are chosen
/// [m/s^2].
inline constexpr double kCommonRoadAcceleration = 2.5;

/// Distance from the rear axle to the center of the car of a planning problem [m]. The used
/// distance is that from the rear axle to the center of gravity of CommonRoad's vehicle 2 (BMW
/// 320i).
inline constexpr double kCommonRoadCenterAhead = 1.42200396;

/// Whether the text is an XML document with the root element `commonRoad`.
bool IsCommonRoadScenario(const std::string& text);

/// Reads a CommonRoad scenario of version 2017a, 2018b or 2020a.
///
/// The route changes lanes only between adjacent lanelets with the same driving direction. The
/// route joins a lanelet's center, after the start or a lane change, along a quintic polynomial.
/// The route's lateral acceleration on this polynomial is at most 1.5 m/s^2 where the road is long
/// enough.
///
/// Properties of the scenario that Trackbed does not model are approximated, with a note. Discs and
/// polygons become their smallest enclosing boxes. An obstacle given as a set of occupied areas
/// becomes several moving boxes, which together cover each area at the middle of the area's time
/// interval. A value that the file gives as an interval becomes the middle of the interval. The
/// reader ignores traffic signs, traffic lights, stop lines, speed limits and environment
/// obstacles. If there are several planning problems or goals, reads the first.
///
/// Throws InputError, with line and element, if the file is not a CommonRoad scenario, if there is
/// no planning problem, or if a number is not finite or out of range. Also throws InputError if no
/// lanelets lead from the start to the goal, or if the route is longer than 50 km. The start of the
/// planning problem must be at most 5 m from a lanelet.
CommonRoadScenario ReadCommonRoadScenario(const std::filesystem::path& file,
                                          const std::string& text);

}  // namespace trackbed
