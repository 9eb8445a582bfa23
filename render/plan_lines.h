#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Returns the overlay that draws the planned path. After each replan, the overlay draws the new
/// path, and the earlier paths remain as faint, narrow lines.
OverlayEntry PlanOverlay();

}  // namespace trackbed::render
