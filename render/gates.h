#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Lines on the ground around the gates that the plan passes, between their cones.
OverlayEntry GateOverlay();

}  // namespace trackbed::render
