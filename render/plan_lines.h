#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// The planned path, and from the moment when the car adopts a new one, that one; those before it
/// stay, faint and narrow.
OverlayEntry PlanOverlay();

}  // namespace trackbed::render
