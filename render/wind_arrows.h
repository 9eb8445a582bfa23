#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// The wind as arrows on the ground around the camera's target, at fixed positions, each as long as
/// the air moves in a third of a second; calm places have none. Also outlines the areas of gusts.
OverlayEntry WindOverlay();

}  // namespace trackbed::render
