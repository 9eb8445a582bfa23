#pragma once

#include <vector>

#include "trackbed/geometry/box_index.h"
#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/world/wind.h"

/// Smooths a path with corners ("Smoothing" of the wind-aware RRT; Thrun 2012). Each inner point of
/// the path moves toward its original position and toward the middle of its two neighbors. A point
/// does not move if an obstacle is in the way or if the wind score would decrease.
///
/// Symbols: x_i are the original points and y_i the smoothed points. The first and the last point
/// of the path are fixed. The weight of the original points is alpha, and the weight of smoothness
/// is beta. The wind is w [m/s], and the airspeed V [m/s].
namespace trackbed {

/// Describes how the wind contributes to the score of a path.
struct WindScoring {
  Wind wind;
  double time = 0.0;    ///< Time at which the gusts of the wind are evaluated [s].
  double speed = 1.0;   ///< Airspeed V of the vehicle [m/s], > 0.
  double weight = 1.0;  ///< Weight k_w of the wind in the score; 0: wind is ignored.
};

/// Returns the wind score W [m] of a path: W = k_w sum(w . dx)/V over the segments dx of the path,
/// with the wind's weight k_w, the airspeed V and the wind w at the middle of each segment. In a
/// tailwind, the wind score is positive. To first order, the wind score is the path length that the
/// wind saves for a vehicle with the airspeed V. In uniform wind, the wind score depends only on
/// the two ends of the path. For a path of fewer than two points, the wind score is 0.
double WindScore(const std::vector<Vec2>& path, const WindScoring& scoring);

struct SmoothingOptions {
  double data = 0.5;  ///< Weight alpha of the original points, >= 0.
  /// Weight beta of smoothness, >= 0. With 0 < alpha + 2 beta < 1 for the weight alpha of the
  /// original points, the smoothing converges without overshoot.
  double smoothness = 0.1;
  /// Smoothing ends after a sweep in which the changes of all coordinates add up to less than
  /// `tolerance` [m], > 0.
  double tolerance = 1e-6;
  int sweeps = 1000;  ///< Maximum number of sweeps over all points, >= 0.
};

struct SmoothingResult {
  std::vector<Vec2> path;
  int sweeps = 0;          ///< Number of sweeps over all points, including the last sweep.
  bool converged = false;  ///< Whether the moves of the last sweep add up to less than `tolerance`.
};

/// Smooths a path, point by point and coordinate by coordinate: y_i <- y_i + alpha (x_i - y_i) +
/// beta (y_{i-1} + y_{i+1} - 2 y_i), with the original points x_i, the smoothed points y_i and the
/// weights alpha and beta. SmoothPath only moves a point if both edges at the point stay farther
/// than `inflation` [m] from every obstacle. The move of a point must also not decrease the wind
/// score of its two edges.
///
/// Guarantees: the two ends of the path do not move, and a path that is free of obstacles stays
/// free. Without obstacles and wind, the smoothed points y_i converge to the solution of (alpha + 2
/// beta) y_i - beta (y_{i-1} + y_{i+1}) = alpha x_i, with the original points x_i. An obstacle may
/// block the motion of a point along x but not along y, or vice versa. The resulting path is a
/// polyline, whose corners are not rounded. Throws InternalError if an option is out of range.
/// Computing time of the smoothing: O(sweeps x points x obstacles).
SmoothingResult SmoothPath(const std::vector<Vec2>& path, const std::vector<OrientedBox>& obstacles,
                           const Inflation& inflation, const WindScoring& wind,
                           const SmoothingOptions& options);

}  // namespace trackbed
