#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// For each event of events.h, a mark on the ground at the car's position, from the event's start
/// on. While the event lasts, a line of text stands above the readings. In a collision or a
/// roll-over, a frame around the picture flashes.
OverlayEntry EventOverlay();

}  // namespace trackbed::render
