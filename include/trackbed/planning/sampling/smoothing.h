#pragma once

#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/world/wind.h"

/// Smooths a path with corners ("Smoothing" of the wind-aware RRT; Thrun 2012): each inner point
/// moves toward its original position and toward the middle of its neighbors, unless an obstacle is
/// in the way or the wind score would decrease.
///
/// Symbols: x_i given points, y_i smoothed points, both ends fixed; alpha weight of the data, beta
/// weight of smoothness; w wind [m/s]; V airspeed [m/s].
namespace trackbed {

/// Describes how the wind contributes to the score of a path.
struct WindScoring {
  Wind wind;
  double time = 0.0;    ///< Time at which gusts are evaluated [s].
  double speed = 1.0;   ///< Airspeed V [m/s], > 0.
  double weight = 1.0;  ///< Weight k_w; 0: wind is ignored.
};

/// Returns the wind score W [m] of a path: W = k_w sum(w . dx)/V over the segments dx of the path,
/// with the wind w at the middle of each segment. The score is positive in tailwind. To first
/// order, the score is the length that the wind saves for a vehicle with airspeed V. In uniform
/// wind, the score depends only on the ends of the path. The score is 0 for fewer than two points.
double WindScore(const std::vector<Vec2>& path, const WindScoring& scoring);

struct SmoothingOptions {
  double data = 0.5;  ///< Weight alpha, >= 0.
  /// Weight beta, >= 0. With 0 < alpha + 2 beta < 1, the smoothing converges without overshoot.
  double smoothness = 0.1;
  /// Smoothing ends when the changes of all coordinates in a sweep add up to less than `tolerance`
  /// [m], which must be > 0.
  double tolerance = 1e-6;
  int sweeps = 1000;  ///< Maximum number of sweeps, >= 0.
};

struct SmoothingResult {
  std::vector<Vec2> path;
  int sweeps = 0;          ///< Number of sweeps, including the last sweep.
  bool converged = false;  ///< Whether the last sweep moved the points by less than the tolerance.
};

/// Smooths a path, point by point and coordinate by coordinate: y_i <- y_i + alpha (x_i - y_i) +
/// beta (y_{i-1} + y_{i+1} - 2 y_i). A move of a point is accepted if both edges at the point are
/// farther than `inflation` [m] from every obstacle, and the wind score of the two edges does not
/// decrease.
///
/// Guarantees: the ends do not move, and a free path stays free. Without obstacles and wind, the
/// path converges to (alpha + 2 beta) y_i - beta (y_{i-1} + y_{i+1}) = alpha x_i. Obstacles may
/// stop a point in only one of its coordinates. The result is a polyline: corners are not rounded.
/// Errors: InternalError for options out of range. Cost: O(sweeps x points x obstacles).
SmoothingResult SmoothPath(const std::vector<Vec2>& path, const std::vector<OrientedBox>& obstacles,
                           double inflation, const WindScoring& wind,
                           const SmoothingOptions& options);

}  // namespace trackbed
