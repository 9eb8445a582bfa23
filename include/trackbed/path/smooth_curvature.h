#pragma once

#include "trackbed/path/path.h"

namespace trackbed {

/// Averages a path over `window` [m] around each of its points, so that a curvature jump (a line
/// joined to an arc) becomes a ramp over the window. Motions along a path need a continuous
/// curvature (path/frenet_frame.h). A car with a limited steering rate can follow a ramp, but not a
/// jump.
///
/// Guarantees: the curvature is continuous. The deviation, toward the inside of bends, is at most
/// window^2/24 times the largest curvature k within the window. Lines stay unchanged except within
/// half a window of a bend. The curvature of arcs grows by a fraction (k window)^2/24, and their
/// length shrinks by that fraction. Stations of the result differ slightly from those of the path.
/// Errors: InternalError unless the window is positive and the path is driven forwards and longer
/// than 0. Cost: about 10 us per meter.
Path SmoothCurvature(const Path& path, double window);

}  // namespace trackbed
