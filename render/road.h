#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Returns the overlay that draws the pavement and road marks of the world's road network
/// (Recording::roads). Without a road network, the road overlay draws asphalt along the plan
/// (Recording::road), with edge lines, dashed lines between lanes and posts every 10 m. On open
/// ground, the road overlay draws nothing.
OverlayEntry RoadOverlay();

}  // namespace trackbed::render
