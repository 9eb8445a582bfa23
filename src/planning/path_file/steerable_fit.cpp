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

double CurvatureLimit(const VehicleParams& vehicle) {
  return CurvatureForSteering(vehicle, SteeringReach(vehicle, 0.0));
}

}  // namespace

SharpestPoint SharpestPointOf(const Path& path) {
  SharpestPoint sharpest;
  double s = 0.0;
  for (const Segment& segment : path.segments()) {
    for (const double along : {0.0, segment.length}) {
      const double curvature = std::abs(segment.CurvatureAt(along));
      if (curvature > sharpest.curvature) {
        sharpest = {curvature, s + along};
      }
    }
    s += segment.length;
  }
  return sharpest;
}

std::optional<SteerableFit> FitWithinSteering(const FittedPath& fitted,
                                              const VehicleParams& vehicle) {
  // Share of the car's largest curvature that the fit aims at: FitPathWithin exceeds its bound by
  // at most 1e-3.
  constexpr double kShare = 1.0 - 1e-3;
  const double limit = CurvatureLimit(vehicle);
  const double largest = SharpestPointOf(fitted.path).curvature;
  if (fitted.smoothing_length == 0.0 || largest <= limit) {
    return std::nullopt;
  }
  try {
    FittedPath bounded =
        FitPathWithin(fitted.given, fitted.options, kShare * limit, fitted.path.At(0.0).pose.yaw);
    if (SharpestPointOf(bounded.path).curvature > limit) {
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

std::optional<double> SteerableDeviation(const FittedPath& fitted, const VehicleParams& vehicle) {
  constexpr double kLargest = 1.0;  // [m]
  if (fitted.options.fit != PathFit::kSpline) {
    return std::nullopt;
  }
  PathFitOptions options = fitted.options;
  while (options.max_deviation < kLargest) {
    options.max_deviation = std::min(2.0 * options.max_deviation, kLargest);
    try {
      const FittedPath smoother = FitPath(fitted.given, options);
      if (smoother.reversals.empty() &&
          (SharpestPointOf(smoother.path).curvature <= CurvatureLimit(vehicle) ||
           FitWithinSteering(smoother, vehicle))) {
        return options.max_deviation;
      }
    } catch (const InputError&) {
      continue;
    }
  }
  return std::nullopt;
}

}  // namespace trackbed
