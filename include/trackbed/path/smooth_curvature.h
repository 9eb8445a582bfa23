#pragma once

#include "trackbed/path/path.h"

namespace trackbed {

/// Smooths a path by averaging over the distance `window` [m] around each point of the path. A jump
/// of the curvature, where a line meets an arc, becomes a linear ramp of the length `window`.
/// Planning motions relative to a path requires a path with continuous curvature
/// (path/frenet_frame.h). A car with a limited steering rate can follow a ramp of the curvature,
/// but not a jump.
///
/// Guarantees: the curvature of the smoothed path is continuous. The smoothed path deviates from
/// the original path toward the inside of bends, by at most window^2/24 times the largest curvature
/// k within the window. Straight lines stay unchanged, except at points closer to a bend than half
/// the averaging window. Smoothing increases the curvature k of an arc by the fraction (k
/// window)^2/24, and shortens the arc by the same fraction. Because the smoothed path has another
/// length, its stations differ slightly from the stations on the original path. Throws
/// InternalError unless the window is positive, the path is driven forwards, and the length of the
/// path is positive. Smoothing takes about 10 us per meter of path.
Path SmoothCurvature(const Path& path, double window);

}  // namespace trackbed
