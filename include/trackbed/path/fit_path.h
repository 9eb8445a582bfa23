#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/path.h"

/// Fits paths through points planned by another program.
namespace trackbed {

/// Points of a path in the order of travel. Lists other than `points` are empty or have one entry
/// per point.
struct PathPoints {
  std::vector<Vec2> points;       ///< Positions of the rear-axle center [m].
  std::vector<double> yaw;        ///< Headings of the car [rad].
  std::vector<double> curvature;  ///< Curvatures, positive to the left [1/m].
  std::vector<double> speed;      ///< Speeds [m/s], >= 0.
  std::vector<int> lines{};       ///< Line numbers in the file, from 1, for messages.
};

/// How a path is fitted to the points.
enum class PathFit {
  kPolyline,  ///< Straight lines between the points, with corners.
  kSpline,    ///< The smoothest spline that stays within max_deviation of every point.
};

struct PathFitOptions {
  PathFit fit = PathFit::kSpline;
  double max_deviation = 0.05;  ///< Largest distance of a spline from the points [m], > 0.
  bool closed = false;          ///< Whether the path returns to its first point.
  /// Spacing of resampling before the fit [m]; nullopt: fits the given points.
  std::optional<double> resample{};
};

/// A point at which the direction of travel jumps.
struct HeadingJump {
  std::size_t point = 0;       ///< Index among the points, from 0.
  double s = 0.0;              ///< Station of the point [m].
  Vec2 position{0.0, 0.0};     ///< Position of the point [m].
  double angle = 0.0;          ///< Change of direction, positive to the left [rad].
  Stations rounded{0.0, 0.0};  ///< Stations of the arc that replaces the corner [m].
};

/// A path that was fitted to points, with the result of the fit.
struct FittedPath {
  PathPoints given;
  PathFitOptions options;
  Path path;
  std::vector<double> stations;  ///< Station of each point [m].
  /// Largest distance of a point from the path's point at its station [m].
  double deviation = 0.0;
  std::size_t deviation_point = 0;  ///< Index of the point with the largest deviation.
  double bulge = 0.0;          ///< Largest distance of a spline from the lines between points [m].
  double bulge_station = 0.0;  ///< Station at the start of the line with the largest bulge [m].
  std::size_t repeated = 0;    ///< Number of points dropped because they equal the preceding point.
  std::vector<HeadingJump> jumps;  ///< Corners of a polyline, larger than 1e-9 rad.
  /// Points at which the direction of travel changes by more than kMaxHeadingJump. If there are any
  /// reversals, no path is fitted.
  std::vector<HeadingJump> reversals;
  double smoothing_length = 0.0;  ///< Smoothing length l of a spline [m]; 0 for a polyline.
  /// Largest difference between a given heading and the path's [rad].
  double heading_difference = 0.0;
};

/// Largest length of a path that can be fitted, measured along the straight lines between its
/// points [m].
inline constexpr double kMaxPathLength = 200e3;

/// Largest change of the direction of travel at a point [rad]. A path with a larger change cannot
/// be fitted.
inline constexpr double kMaxHeadingJump = 2.8;

/// Converts a path of a reference point to that of the rear-axle center. The reference point, such
/// as the center of gravity, lies on the car's axis, `ahead` [m] of the rear axle. The result is
/// exact if headings are given. Otherwise the rear axle follows the reference point without slip (a
/// tractrix), starting on the circle through the first three points. Keeps the speeds, but drops
/// the curvatures, because they belong to the curve of the reference point.
PathPoints AtRearAxle(PathPoints given, double ahead);

/// Fits a path through or along the points.
///
/// A Path has a continuous heading, so each corner of a polyline becomes an arc of at most 2 mm,
/// within 1 mm of the corner and far too tight for any car.
///
/// A spline has degree 5 over the chord length u, with a knot at every point, and minimizes
///     sum over i of w_i |P(u_i) - p_i|^2 + l^6 integral of |P'''(u)|^2 du,
/// where w_i [m] is the length of path that point i represents, and l [m] the smoothing length.
/// Details shorter than l are smoothed out (Reinsch 1967). Unlike in Reinsch's method, the integral
/// penalizes the third derivative, which favors slow steering. Bisection finds the largest l, to 10
/// %, for which the deviation is at most max_deviation. Curvature and curvature rate are
/// continuous. At the ends of the path, P''' is 0: the curvature rate falls to 0 over about two
/// points or l, whichever is longer. Next to these ends, the curvature rate is up to a tenth too
/// large.
///
/// Guarantees: no point lies further than max_deviation from the path's point at its station, as
/// measured on the path. With `resample`, the guarantee holds for the resampled points on the
/// straight lines. Between widely spaced points a spline bulges, next to corners by a tenth of the
/// spacing or more (see `bulge`). The bulge is at most a fifth of the spacing, or the height of an
/// arc that turns with the points if that is larger. The fit does not account for obstacles or the
/// limits of a car.
///
/// Errors: InputError for fewer than two different points, for more than 200 000 points to be
/// fitted, and for a deviation that cannot be met. InputError naming the first point whose heading
/// is opposite to the direction of travel. InputError naming the largest gap if the path is longer
/// than kMaxPathLength. InputError naming the point that is probably wrong if a spline bulges
/// further than guaranteed. PreconditionError for numbers that are not finite and for lists of
/// different lengths. Cost of a spline: about 0.2 ms per point and 30 us per meter, 1 kB per point
/// and 1 kB per meter.
FittedPath FitPath(PathPoints given, const PathFitOptions& options);

}  // namespace trackbed
