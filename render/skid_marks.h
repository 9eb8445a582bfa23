#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Black marks where a tyre of the car used more than 0.9 of its grip, up to the time of the
/// picture. Only for plants whose log has tyre forces.
OverlayEntry SkidMarkOverlay();

}  // namespace trackbed::render
