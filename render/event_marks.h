#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// A mark on the ground where the car was at each event of events.h, from then on, and a line of
/// text for each over the readings while it lasts; in a collision and a roll-over the picture's
/// frame flashes.
OverlayEntry EventOverlay();

}  // namespace trackbed::render
