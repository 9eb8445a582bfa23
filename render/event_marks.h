#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// A mark on the ground at the car's position for each event of events.h, shown from its start on,
/// and a line of text above the readings while it lasts. In a collision or a roll-over, a frame
/// around the picture flashes.
OverlayEntry EventOverlay();

}  // namespace trackbed::render
