#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Contour lines of ground that is not level, and of each bump and side slope, so that hills and
/// bumps are seen.
OverlayEntry ReliefOverlay();

/// The height between contour lines of ground that spans so much height [m]: 1, 2 or 5 times a
/// power of ten, such that there are at most 40.
double ContourInterval(double span);

}  // namespace trackbed::render
