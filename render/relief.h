#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Contour lines of ground that is not level, and of each bump and side slope. Contour lines make
/// hills and bumps visible.
OverlayEntry ReliefOverlay();

/// Height between contour lines for ground whose heights span `span` [m]. The interval is 1, 2 or 5
/// times a power of ten, with at most 40 lines.
double ContourInterval(double span);

}  // namespace trackbed::render
