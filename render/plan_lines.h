#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// The planned path and, after a replan, the new one; earlier plans remain as faint, narrow lines.
OverlayEntry PlanOverlay();

}  // namespace trackbed::render
