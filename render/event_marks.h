#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Draws a mark on the ground for each event of events.h, at the car's position at the start of the
/// event. While an event lasts, its text is shown above the readings. In a collision or a
/// roll-over, a border around the frame flashes.
OverlayEntry EventOverlay();

}  // namespace trackbed::render
