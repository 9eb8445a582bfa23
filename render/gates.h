#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Draws a line on the ground around each gate that the plan passes, from cone to cone.
OverlayEntry GateOverlay();

}  // namespace trackbed::render
