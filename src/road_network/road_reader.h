#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "src/road_network/xml_fields.h"
#include "trackbed/road_network/road_network.h"

/// Reads the parts of an OpenDRIVE file.
namespace trackbed {

/// Reads a <road> element, and adds its errors to `problems`.
Road ReadRoad(const tinyxml2::XMLElement& element, XmlProblems& problems);

/// Reads the reference line of a road from its <planView>. Returns an empty line after an error.
ReferenceLine ReadPlanView(const XmlFields& road, double length);

/// Reads the cubic polynomials from the child elements with the name `name`. The attribute with the
/// name `start` contains the station at which a polynomial begins.
PiecewiseCubic ReadCubics(const tinyxml2::XMLElement* parent, const char* name, const char* start,
                          const std::string& where, XmlProblems& problems);

/// Reads the elements <laneSection> of <lanes>. Height definitions that Trackbed does not read are
/// added to `unread_heights`.
std::vector<LaneSection> ReadLaneSections(const XmlFields& lanes, const Road& road,
                                          std::vector<std::string>& unread_heights);

/// Reads a contact point, which is "start" or "end". Other values are an error.
RoadEnd ReadContactPoint(const XmlFields& fields);

/// Reports all links to roads, junctions and lanes that do not exist.
void CheckLinks(const RoadNetwork& network, XmlProblems& problems);

}  // namespace trackbed
