#pragma once

#include "trackbed/path/fit_path.h"

namespace trackbed {

/// Fits a path as FitPathWithin (fit_path.h) does, but with the prescribed heading `start_yaw`
/// [rad] of the car at the start. With `start_yaw`, a new fit of a path can keep the start pose at
/// which a car already stands.
///
/// Guarantees: the same as for FitPathWithin. The heading at the start of an open path is
/// `start_yaw` to 1e-6 rad, unless the path follows the headings of the points. Throws the same
/// errors as FitPathWithin.
FittedPath FitPathWithin(PathPoints given, const PathFitOptions& options, double max_curvature,
                         double start_yaw);

}  // namespace trackbed
