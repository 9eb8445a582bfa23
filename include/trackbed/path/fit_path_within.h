#pragma once

#include "trackbed/path/fit_path.h"

namespace trackbed {

/// Fits a path to the points as FitPath does, with a bound on the curvature of a spline. Where the
/// curvature of the points jumps, as where a line joins an arc, the curve of FitPath has a
/// curvature of up to 6 % above that of the arc. FitPathWithin spreads the change of curvature over
/// a longer part of the curve instead, within PathFitOptions::max_deviation. A car drives such a
/// curve on an arc near the smallest radius that the car can steer.
///
/// Guarantees: the same as FitPath. The curvature of the path is at most `max_curvature` [1/m], to
/// a relative 1e-3, if a curve of least variation with this bound stays within max_deviation of the
/// points. Otherwise, the curvature may exceed the bound; the caller must check the path. The bound
/// has no effect on a polyline, or on a path with the headings and curvatures of the points.
///
/// Throws InputError in the same cases as FitPath, and PreconditionError unless max_curvature > 0.
FittedPath FitPathWithin(PathPoints given, const PathFitOptions& options, double max_curvature);

}  // namespace trackbed
