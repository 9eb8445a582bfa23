#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Returns the overlay that draws the run's other plants as translucent cars, each with its
/// footprint.
OverlayEntry GhostOverlay();

}  // namespace trackbed::render
