#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Draws the planned path and, after a replan, the new one. Earlier plans remain as faint, narrow
/// lines.
OverlayEntry PlanOverlay();

}  // namespace trackbed::render
