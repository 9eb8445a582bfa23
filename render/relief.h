#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Returns the overlay that draws contour lines of ground that is not level, and of each bump and
/// side slope. The contour lines make hills and bumps visible.
OverlayEntry ReliefOverlay();

/// Returns the height interval between contour lines [m] for ground whose highest point is `span`
/// above its lowest point [m]. The height interval is 1, 2 or 5 times a power of ten, and yields at
/// most 40 contour lines.
double ContourInterval(double span);

}  // namespace trackbed::render
