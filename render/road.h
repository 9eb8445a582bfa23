#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// The pavement and road marks of the world's road network (Recording::roads). Without a road
/// network, draws asphalt along the plan (Recording::road), with edge lines, dashed lines between
/// lanes and posts every 10 m. On open ground, RoadOverlay draws nothing.
OverlayEntry RoadOverlay();

}  // namespace trackbed::render
