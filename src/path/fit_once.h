#pragma once

#include <limits>
#include <optional>

#include "trackbed/path/fit_path.h"

namespace trackbed {

/// Throws PreconditionError if the arguments of FitPath are invalid.
void CheckFitArguments(const PathPoints& given, const PathFitOptions& options);

/// Fits a path as FitPath does, without a search for a larger deviation if the fit fails, and with
/// the bound `max_curvature` [1/m] as in FitPathWithin. The car has the heading `start_yaw` [rad]
/// at the start of an open path, if it is given. FitOnce does not check its arguments.
FittedPath FitOnce(PathPoints given, const PathFitOptions& options,
                   double max_curvature = std::numeric_limits<double>::infinity(),
                   std::optional<double> start_yaw = {});

}  // namespace trackbed
