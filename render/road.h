#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// The pavement and road marks of the world's road network (Recording::roads). Without one, asphalt
/// along the plan of the recording (Recording::road), with edge lines, dashed lines between lanes
/// and posts every 10 m; nothing on open ground.
OverlayEntry RoadOverlay();

}  // namespace trackbed::render
