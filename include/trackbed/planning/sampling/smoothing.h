#pragma once

#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/world/wind.h"

/// Smoothing of a path with corners ("Smoothing" of the wind-aware RRT; Thrun 2012): each inner
/// point moves toward its original position and toward the middle of its neighbors, as long as no
/// obstacle is in the way and the wind score does not fall.
///
/// Symbols: x_i given points, y_i smoothed points, both ends fixed; alpha weight of the data, beta
/// weight of smoothness; w wind [m/s]; V airspeed [m/s].
namespace trackbed {

/// How wind counts in the length of a path.
struct WindScoring {
  Wind wind;
  double time = 0.0;    ///< at which gusts are evaluated [s]
  double speed = 1.0;   ///< V [m/s], > 0
  double weight = 1.0;  ///< k_w; 0: wind does not count
};

/// W = k_w sum over segments of w(middle) . dx / V [m], positive with the wind: to first order, the
/// length that the wind saves for a vehicle with airspeed V. In uniform wind it depends only on the
/// ends. 0 for fewer than two points.
double WindScore(const std::vector<Vec2>& path, const WindScoring& scoring);

struct SmoothingOptions {
  double data = 0.5;        ///< alpha, >= 0
  double smoothness = 0.1;  ///< beta, >= 0; 0 < alpha + 2 beta < 1: converges without overshoot
  /// Ends when the sum over all coordinates of the changes in a sweep is smaller [m], > 0.
  double tolerance = 1e-6;
  int sweeps = 1000;  ///< at most, >= 0
};

struct SmoothingResult {
  std::vector<Vec2> path;
  int sweeps = 0;          ///< number of sweeps, including the last one
  bool converged = false;  ///< the last sweep moved less than the tolerance
};

/// y_i <- y_i + alpha (x_i - y_i) + beta (y_{i-1} + y_{i+1} - 2 y_i), point by point and coordinate
/// by coordinate. A move is accepted if both edges at the point keep further than `inflation` [m]
/// from every obstacle, and the wind score of the two edges does not fall.
///
/// Guarantees: ends do not move; a free path stays free; without obstacles and wind it converges to
/// (alpha + 2 beta) y_i - beta (y_{i-1} + y_{i+1}) = alpha x_i. Obstacles may stop a point in one
/// coordinate only. Does not round corners: the result is a polyline. Errors: InternalError for
/// options out of range. Cost O(sweeps x points x obstacles).
SmoothingResult SmoothPath(const std::vector<Vec2>& path, const std::vector<OrientedBox>& obstacles,
                           double inflation, const WindScoring& wind,
                           const SmoothingOptions& options);

}  // namespace trackbed
