#pragma once

#include "trackbed/path_files/drawn_lanes.h"
#include "trackbed/road_network/road_paint.h"

namespace trackbed {

/// Returns the surfaces and bounds of lanes, for drawing. Each lane is drawn as a band. The bound
/// between two lanes of the same direction is a broken line with dashes of 3 m every 9 m. All other
/// lane bounds are solid lines. A bound that two lanes share is drawn once; its ends must agree to
/// 1 cm.
RoadPaint PaintLanes(const DrawnLanes& lanes);

}  // namespace trackbed
