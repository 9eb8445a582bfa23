#pragma once

#include "trackbed/path/path.h"

namespace trackbed {

/// The path averaged over `window` [m] around each of its points: where its curvature jumps (lines
/// joined to arcs) it then changes steadily over the window, which is what motions along a path
/// need (path/frenet_frame.h), and which a car with a limited steering rate can follow.
///
/// Guarantees: continuous curvature; nowhere further from the path than window^2/24 times its
/// largest curvature k within the window, toward the inside of bends; lines stay where they are,
/// but for half a window beside a bend; arcs get tighter by (k window)^2/24 of their curvature, the
/// path shorter by as much of theirs. Stations are its own, about those of the path. Errors:
/// InternalError unless the window is positive and the path is driven forwards and longer than 0.
/// Cost: about 10 us a meter.
Path SmoothCurvature(const Path& path, double window);

}  // namespace trackbed
