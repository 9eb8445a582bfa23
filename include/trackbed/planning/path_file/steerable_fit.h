#pragma once

#include <optional>
#include <string>

#include "trackbed/path/fit_path.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// A path that was fitted with the car's largest curvature as a bound.
struct SteerableFit {
  FittedPath path;
  std::string note;  ///< Says for people that the fit is bounded, and why.
};

/// Fits the path anew if its curvature exceeds what the car can steer: the curve of least variation
/// exceeds the curvature of an arc that joins a line. Keeps the pose at the start. Returns nullopt
/// if the car can steer the path as it is, or no path within PathFitOptions::max_deviation from the
/// points. The planner `path_file` and the verb `check-path` use the result instead of the path.
std::optional<SteerableFit> FitWithinSteering(const FittedPath& fitted,
                                              const VehicleParams& vehicle);

}  // namespace trackbed
