#include "trackbed/path/bounded_fit.h"

#include <cmath>
#include <utility>

#include "src/path/fit_once.h"
#include "trackbed/core/error.h"

namespace trackbed {

FittedPath FitPathWithin(PathPoints given, const PathFitOptions& options, double max_curvature,
                         double start_yaw) {
  TRACKBED_REQUIRE(max_curvature > 0.0 && std::isfinite(start_yaw),
                   "FitPathWithin: a curvature of {} 1/m, a heading of {} rad; must be above 0 and "
                   "finite",
                   max_curvature, start_yaw);
  CheckFitArguments(given, options);
  return FitOnce(std::move(given), options, max_curvature, start_yaw);
}

}  // namespace trackbed
