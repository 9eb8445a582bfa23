#pragma once

#include "src/road_network/road_reader.h"

namespace trackbed {

/// Reads the reference line of a road from its <planView>. If the plan view has an error, returns
/// an empty reference line. The coordinates of the returned line are relative to the point `origin`
/// of the file [m].
ReferenceLine ReadPlanView(const XmlFields& road, const Vec2& origin);

/// Reads the length of a road [m]. If the attribute `length` is missing or wrong by more than 0.1
/// m, adds a note on this flaw, and returns the station at which the reference line ends.
double ReadLength(const XmlFields& road, const ReferenceLine& reference);

}  // namespace trackbed
