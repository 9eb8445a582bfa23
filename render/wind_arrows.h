#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Returns the overlay that draws the wind as arrows on the ground around the camera's target, at
/// fixed positions. The length of an arrow is the distance that the air moves in a third of a
/// second, within limits; places with hardly any wind have no arrow. The wind overlay also outlines
/// the areas of gusts.
OverlayEntry WindOverlay();

}  // namespace trackbed::render
