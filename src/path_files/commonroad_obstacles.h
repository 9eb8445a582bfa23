#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "src/path_files/commonroad_xml.h"
#include "trackbed/path_files/commonroad_scenario.h"

namespace trackbed {

/// The time steps of a CommonRoad scenario.
struct CommonRoadClock {
  double timestep = 0.1;  ///< Duration of a step [s].
  double start = 0.0;     ///< Number of the time step at which the run starts.
};

/// Returns the position in the child element `position` of a CommonRoad state, with the yaw 0. The
/// place of a region is the region's center.
Pose2 ReadPlace(const tinyxml2::XMLElement& state, const CommonRoadReading& reading);

/// Reads the element rectangle, circle or polygon as a region. Replaces a polygon by its enclosing
/// rectangle, because the polygon may not be convex.
CommonRoadRegion ReadRegion(const tinyxml2::XMLElement& shape, const CommonRoadReading& reading);

/// Reads the static and dynamic obstacles of a scenario. ReadCommonRoadObstacles adds notes on
/// approximated obstacles.
std::vector<CommonRoadObstacle> ReadCommonRoadObstacles(const tinyxml2::XMLElement& root,
                                                        const CommonRoadClock& clock,
                                                        const CommonRoadReading& reading,
                                                        std::vector<std::string>& notes);

}  // namespace trackbed
