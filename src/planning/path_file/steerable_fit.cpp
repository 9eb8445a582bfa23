#include "trackbed/planning/path_file/steerable_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/path/bounded_fit.h"
#include "trackbed/vehicle/steering_reach.h"

namespace trackbed {
namespace {

/// Returns the largest absolute curvature of a path [1/m]. Segments of fitted paths are so short
/// that the curvature is largest at an end of a segment.
double LargestCurvature(const Path& path) {
  double largest = 0.0;
  for (const Segment& segment : path.segments()) {
    largest = std::max(
        {largest, std::abs(segment.curvature), std::abs(segment.CurvatureAt(segment.length))});
  }
  return largest;
}

}  // namespace

std::optional<SteerableFit> FitWithinSteering(const FittedPath& fitted,
                                              const VehicleParams& vehicle) {
  // Share of the car's largest curvature that the fit aims at: FitPathWithin exceeds its bound by
  // at most 1e-3.
  constexpr double kShare = 1.0 - 1e-3;
  const double limit = CurvatureForSteering(vehicle, SteeringReach(vehicle, 0.0));
  const double largest = LargestCurvature(fitted.path);
  if (fitted.smoothing_length == 0.0 || largest <= limit) {
    return std::nullopt;
  }
  try {
    FittedPath bounded =
        FitPathWithin(fitted.given, fitted.options, kShare * limit, fitted.path.At(0.0).pose.yaw);
    if (LargestCurvature(bounded.path) > limit) {
      return std::nullopt;
    }
    return SteerableFit{
        std::move(bounded),
        fmt::format("the path is fitted with at most the car's curvature of {:.4g} 1/m; otherwise "
                    "its curvature would be up to {:.4g} 1/m",
                    limit, largest)};
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace trackbed
