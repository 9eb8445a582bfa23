#pragma once

#include <optional>
#include <string>

#include "trackbed/path/fit_path.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// A path that was fitted with the car's largest curvature as a bound.
struct SteerableFit {
  FittedPath path;
  /// Note for the user that the curvature of the fit is bounded, with the reason.
  std::string note;
};

/// Fits the path again, with bounded curvature, if its curvature exceeds the largest curvature that
/// the car can steer. For example, FitPath's curve through the points of an arc and a line exceeds
/// the arc's curvature near the joint. The new fit keeps the start pose of the given path. Returns
/// nullopt if the car can steer the given path. FitWithinSteering also returns nullopt if the car
/// can steer no path within PathFitOptions::max_deviation from the points. The planner `path_file`
/// and the verb `check-path` use the returned path instead of the given path.
std::optional<SteerableFit> FitWithinSteering(const FittedPath& fitted,
                                              const VehicleParams& vehicle);

/// The point of a path with the largest absolute curvature.
struct SharpestPoint {
  double curvature = 0.0;  ///< Absolute curvature [1/m], >= 0.
  double station = 0.0;    ///< Station of the point [m].
};

/// Returns the sharpest point of a fitted path. The segments of a fitted path are so short that the
/// curvature is largest at an end of a segment.
SharpestPoint SharpestPointOf(const Path& path);

/// Returns a value of PathFitOptions::max_deviation [m] with which the points give a path that the
/// car can steer, as the remedy for points with noise. Doubles the given value until the car can
/// steer the path. Returns nullopt if the car can steer no path within a meter, or if the path is a
/// polyline. Computing time: up to ten times that of FitPath.
std::optional<double> SteerableDeviation(const FittedPath& fitted, const VehicleParams& vehicle);

}  // namespace trackbed
