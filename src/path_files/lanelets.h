#pragma once

#include <tinyxml2.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "src/path_files/commonroad_xml.h"
#include "trackbed/path_files/commonroad_scenario.h"
#include "trackbed/path_files/drawn_lanes.h"

/// Roads as lanelets, and routes along them.
namespace trackbed {

/// A lanelet: a piece of a lane between two bounds.
struct Lanelet {
  std::vector<Vec2> left;    ///< Left bound, in the direction of driving [m].
  std::vector<Vec2> right;   ///< Right bound, with as many points as `left` [m].
  std::vector<Vec2> center;  ///< Center line, with as many points as `left` [m].
  std::vector<std::string> successors;
  std::vector<std::string> neighbors;  ///< Adjacent lanelets with the same driving direction.
  int line = 0;                        ///< Line number of the lanelet in the file.
  Vec2 low{0.0, 0.0};                  ///< Smallest x and y of the lanelet's bounds [m].
  Vec2 high{0.0, 0.0};                 ///< Largest x and y of the lanelet's bounds [m].

  [[nodiscard]] double Length() const;
  /// Whether the lanelet contains the point.
  [[nodiscard]] bool Contains(const Vec2& point) const;
};

using Lanelets = std::map<std::string, Lanelet>;

/// Returns a lanelet between two bounds of at least two points in the direction of driving; bounds
/// with different numbers of points are resampled. Returns nullopt if the center line is a point.
std::optional<Lanelet> LaneletBetween(std::vector<Vec2> left, std::vector<Vec2> right);

/// Returns the bounds of the lanelets within 150 m of the path.
DrawnLanes DrawnLanesOf(const Lanelets& lanelets, const std::vector<Vec2>& path);

/// Reads all lanelets of a scenario. Leaves out lanelets without a length, and ignores links to
/// lanelets that are not in the file.
Lanelets ReadLanelets(const tinyxml2::XMLElement& root, const CommonRoadReading& reading);

/// Returns `count` >= 1 convex regions that cover a lanelet: four-sided pieces between its bounds.
std::vector<CommonRoadRegion> RegionsOf(const Lanelet& lanelet, std::size_t count);

/// A part of a route without a lane change: consecutive lanelets.
using LaneletLane = std::vector<const Lanelet*>;

/// The place at which a car meets a polyline.
struct PolylinePlace {
  double station = 0.0;   ///< Station of the polyline's nearest point [m].
  double distance = 0.0;  ///< Distance of the car from the nearest point of the polyline [m].
  double offset = 0.0;    ///< Signed `distance`, positive to the left of the polyline [m].
  double yaw = 0.0;       ///< Direction of the polyline at the nearest point [rad].
};
PolylinePlace PlaceOn(const std::vector<Vec2>& line, const Vec2& point);

/// Finds the shortest route from one of the lanelets `starts` to one of the lanelets `goals`, as
/// the parts between lane changes. A change to an adjacent lanelet counts as 5 m; among equally
/// long routes, returns the one that changes lanes earlier. Returns nullopt if no route leads to a
/// goal.
std::optional<std::vector<LaneletLane>> FindLaneletRoute(const Lanelets& lanelets,
                                                         const std::vector<std::string>& starts,
                                                         const std::vector<std::string>& goals);

/// Returns the lanelets that contain the point of a pose, first the lanelet whose direction differs
/// least from the pose's heading. If no lanelet contains the point, returns the nearest lanelet
/// within 5 m; empty if all lanelets are farther away. Ignores lanelets whose direction differs by
/// more than a right angle.
std::vector<std::string> LaneletsAt(const Lanelets& lanelets, const Pose2& pose);

}  // namespace trackbed
