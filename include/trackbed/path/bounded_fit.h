#pragma once

#include "trackbed/path/fit_path.h"

namespace trackbed {

/// Fits a path as FitPathWithin (fit_path.h) does, with a prescribed heading of the car at its
/// start, `start_yaw` [rad]. A refined fit then begins with the pose of the first fit, at which a
/// car already stands.
///
/// Guarantees: as FitPathWithin. The heading at the start of an open path is `start_yaw` to
/// 1e-6 rad, unless the path follows the headings of the points. Throws the same errors.
FittedPath FitPathWithin(PathPoints given, const PathFitOptions& options, double max_curvature,
                         double start_yaw);

}  // namespace trackbed
