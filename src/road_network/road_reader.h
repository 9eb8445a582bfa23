#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "src/road_network/xml_fields.h"
#include "trackbed/road_network/road_network.h"

/// Functions that read the parts of an OpenDRIVE file.
namespace trackbed {

/// Reads a <road> element, and adds its errors to `problems`. Links with errors are left out of the
/// road and added to RoadNetwork::broken. The coordinates of the road are relative to the point
/// `origin` of the file [m].
Road ReadRoad(const tinyxml2::XMLElement& element, const Vec2& origin, XmlProblems& problems,
              RoadNetwork& network);

/// Reads the cubic polynomials of a piecewise function from the child elements with the name
/// `name`. The argument `start` is the name of the attribute that contains the station at which a
/// polynomial begins.
PiecewiseCubic ReadCubics(const tinyxml2::XMLElement* parent, const char* name, const char* start,
                          const std::string& where, XmlProblems& problems);

/// Reads a contact point, which is "start" or "end". Any other text of a contact point is an error.
RoadEnd ReadContactPoint(const XmlFields& fields);

/// Adds a flaw for each link to a road, junction or lane that does not exist.
void CheckLinks(const RoadNetwork& network, XmlProblems& problems);

}  // namespace trackbed
