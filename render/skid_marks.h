#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Draws black marks where a tyre of the car used more than 0.9 of its grip, up to the time of the
/// picture. Skid marks exist only for plants whose log has tyre forces.
OverlayEntry SkidMarkOverlay();

}  // namespace trackbed::render
