#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// The wind as arrows on the ground around where the camera looks, at places that do not move with
/// it, each as long as the air moves in a third of a second; where there is next to no wind there
/// is none. And the outlines of the areas in which a gust blows.
OverlayEntry WindOverlay();

}  // namespace trackbed::render
