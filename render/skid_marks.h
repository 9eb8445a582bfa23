#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Black marks where a tyre of the car used more than 0.9 of its grip, up to the moment of the
/// picture; of plants whose log has the forces of tyres.
OverlayEntry SkidMarkOverlay();

}  // namespace trackbed::render
