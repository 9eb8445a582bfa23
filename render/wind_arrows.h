#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Draws the wind as arrows on the ground around the camera's target, at fixed positions. An arrow
/// is as long as the air moves in a third of a second; calm places have none. The overlay also
/// outlines the areas of gusts.
OverlayEntry WindOverlay();

}  // namespace trackbed::render
