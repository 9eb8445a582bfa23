#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "src/road_network/xml_fields.h"
#include "trackbed/road_network/road_network.h"

/// The parts of an OpenDRIVE file.
namespace trackbed {

/// A <road>; what could not be read is among the problems.
Road ReadRoad(const tinyxml2::XMLElement& element, XmlProblems& problems);

/// The <planView> of a road; empty after an error.
ReferenceLine ReadPlanView(const XmlFields& road, double length);

/// The records of cubic polynomials that are called `name`, their start in the attribute `start`.
PiecewiseCubic ReadCubics(const tinyxml2::XMLElement* parent, const char* name, const char* start,
                          const std::string& where, XmlProblems& problems);

/// The <laneSection>s of <lanes>, and what has heights of its own in them.
std::vector<LaneSection> ReadLaneSections(const XmlFields& lanes, const Road& road,
                                          std::vector<std::string>& unread_heights);

/// "start" or "end"; an error for others.
RoadEnd ReadContactPoint(const XmlFields& fields);

/// Errors for links to what is not there.
void CheckLinks(const RoadNetwork& network, XmlProblems& problems);

}  // namespace trackbed
