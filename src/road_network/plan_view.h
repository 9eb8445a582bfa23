#pragma once

#include "src/road_network/road_reader.h"

namespace trackbed {

/// Reads the reference line of a road from its <planView>. If the plan view has an error, returns
/// an empty reference line. Coordinates count from the place `origin` of the file [m].
ReferenceLine ReadPlanView(const XmlFields& road, double length, const Vec2& origin);

}  // namespace trackbed
