#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Returns the overlay that draws skid marks: black marks where a tyre of the car used more than
/// 0.9 of its grip, up to the time of the frame. Skid marks are drawn only if the car's log has
/// tyre forces.
OverlayEntry SkidMarkOverlay();

}  // namespace trackbed::render
