#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Draws a mark on the ground for each event of events.h, at the car's position at the event's
/// start. While an event lasts, a line of text about it is shown above the readings. In a collision
/// or a roll-over, a frame around the picture flashes.
OverlayEntry EventOverlay();

}  // namespace trackbed::render
