#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// The other plants as translucent cars, each with its footprint.
OverlayEntry GhostOverlay();

}  // namespace trackbed::render
