#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/path/fit_path.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Returns the largest absolute curvature of a path [1/m]. Segments of fitted paths are so short
/// that the curvature is largest at an end of a segment.
inline double LargestCurvature(const Path& path) {
  double largest = 0.0;
  for (const Segment& segment : path.segments()) {
    largest = std::max(
        {largest, std::abs(segment.curvature), std::abs(segment.CurvatureAt(segment.length))});
  }
  return largest;
}

/// Fits the path anew if its curvature exceeds what the car can steer: the curve of least variation
/// exceeds the curvature of an arc that joins a line. Returns nullopt if the car can steer the path
/// as it is, or no path within the largest deviation from the points.
inline std::optional<FittedPath> SteerableFit(const FittedPath& fitted,
                                              const VehicleParams& vehicle) {
  // Share of the car's largest curvature that the fit aims at: FitPathWithin exceeds its bound by
  // at most 1e-3.
  constexpr double kShare = 1.0 - 1e-3;
  const double limit = CurvatureForSteering(vehicle, vehicle.steering_limit);
  if (fitted.smoothing_length == 0.0 || LargestCurvature(fitted.path) <= limit) {
    return std::nullopt;
  }
  try {
    FittedPath bounded = FitPathWithin(fitted.given, fitted.options, kShare * limit);
    return LargestCurvature(bounded.path) <= limit ? std::optional(std::move(bounded))
                                                   : std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace trackbed
