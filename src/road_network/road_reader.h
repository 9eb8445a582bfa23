#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "src/road_network/xml_fields.h"
#include "trackbed/road_network/road_network.h"

/// Readers for the parts of an OpenDRIVE file.
namespace trackbed {

/// Reads a <road> element. Adds errors to the problems.
Road ReadRoad(const tinyxml2::XMLElement& element, XmlProblems& problems);

/// Reads the <planView> of a road. Returns an empty line after an error.
ReferenceLine ReadPlanView(const XmlFields& road, double length);

/// Reads the cubic polynomials in the elements `name`. The attribute `start` gives the start of
/// each polynomial.
PiecewiseCubic ReadCubics(const tinyxml2::XMLElement* parent, const char* name, const char* start,
                          const std::string& where, XmlProblems& problems);

/// Reads the <laneSection>s of <lanes>. Adds elements that define separate heights to
/// `unread_heights`.
std::vector<LaneSection> ReadLaneSections(const XmlFields& lanes, const Road& road,
                                          std::vector<std::string>& unread_heights);

/// Reads "start" or "end". Other values are an error.
RoadEnd ReadContactPoint(const XmlFields& fields);

/// Reports links to missing roads, junctions and lanes.
void CheckLinks(const RoadNetwork& network, XmlProblems& problems);

}  // namespace trackbed
