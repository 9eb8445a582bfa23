#pragma once

#include <limits>
#include <optional>

#include "trackbed/path/fit_path.h"

namespace trackbed {

/// Throws PreconditionError if the arguments of FitPath are invalid.
void CheckFitArguments(const PathPoints& given, const PathFitOptions& options);

/// Fits a path as FitPath does, but does not search for a larger deviation if the fit fails. The
/// bound `max_curvature` [1/m] is used as in FitPathWithin. If `start_yaw` [rad] is given, it is
/// the car's heading at the start of an open path. FitOnce does not check its arguments.
FittedPath FitOnce(PathPoints given, const PathFitOptions& options,
                   double max_curvature = std::numeric_limits<double>::infinity(),
                   std::optional<double> start_yaw = {});

}  // namespace trackbed
