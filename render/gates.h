#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Draws lines on the ground around the gates that the plan passes, between the gates' cones.
OverlayEntry GateOverlay();

}  // namespace trackbed::render
