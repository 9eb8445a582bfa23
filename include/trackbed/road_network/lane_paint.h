#pragma once

#include "trackbed/path_files/drawn_lanes.h"
#include "trackbed/road_network/road_paint.h"

namespace trackbed {

/// Returns the surfaces and bounds of lanes, for drawing. Each lane is a band. The bound of two
/// lanes of the same direction is a broken line, dashes of 3 m every 9 m; other bounds are solid.
/// Bounds that two lanes share, with the same ends to 1 cm, are drawn once.
RoadPaint PaintLanes(const DrawnLanes& lanes);

}  // namespace trackbed
