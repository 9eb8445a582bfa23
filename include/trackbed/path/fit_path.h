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
  std::vector<Vec2> points;       ///< of the rear-axle center [m]
  std::vector<double> yaw;        ///< heading of the car [rad]
  std::vector<double> curvature;  ///< positive to the left [1/m]
  std::vector<double> speed;      ///< [m/s], >= 0
  std::vector<int> lines{};       ///< of the file that the points are from, for messages; from 1
};

/// How the points become a path.
enum class PathFit {
  kPolyline,  ///< straight lines from point to point, with corners
  kSpline,    ///< the smoothest spline that stays within max_deviation of every point
};

struct PathFitOptions {
  PathFit fit = PathFit::kSpline;
  double max_deviation = 0.05;  ///< of a spline from the points [m], > 0
  bool closed = false;          ///< the path returns to its first point
  /// Spacing of resampling before the fit [m]; none: fits the points as given.
  std::optional<double> resample{};
};

/// A point at which the direction of travel jumps.
struct HeadingJump {
  std::size_t point = 0;       ///< index among the points, from 0
  double s = 0.0;              ///< station [m]
  Vec2 position{0.0, 0.0};     ///< [m]
  double angle = 0.0;          ///< change of direction, positive to the left [rad]
  Stations rounded{0.0, 0.0};  ///< the arc that replaces the corner [m]
};

/// A path, and how it was fitted to the points.
struct FittedPath {
  PathPoints given;
  PathFitOptions options;
  Path path;
  std::vector<double> stations;     ///< of each point [m]
  double deviation = 0.0;           ///< largest distance of a point from its station [m]
  std::size_t deviation_point = 0;  ///< index of that point
  double bulge = 0.0;          ///< largest distance of a spline from the lines between points [m]
  double bulge_station = 0.0;  ///< start of the line with that distance [m]
  std::size_t repeated = 0;    ///< number of points dropped because they equal the one before
  std::vector<HeadingJump> jumps;  ///< of a polyline, larger than 1e-9 rad
  /// Points at which the path turns back by more than kMaxHeadingJump; there is no path then.
  std::vector<HeadingJump> reversals;
  double smoothing_length = 0.0;  ///< l of a spline [m]; 0 of a polyline
  /// Largest difference between a given heading and the path's [rad].
  double heading_difference = 0.0;
};

/// Longest path, measured along the straight lines between its points [m].
inline constexpr double kMaxPathLength = 200e3;

/// Largest change of the direction of travel at a point [rad]. A path that turns back by more
/// cannot be fitted.
inline constexpr double kMaxHeadingJump = 2.8;

/// Converts a path of a reference point to that of the rear-axle center. The reference point, such
/// as the center of gravity, lies on the car's axis `ahead` [m] of the rear axle. Exact if headings
/// are given. Otherwise the rear axle follows without slip (a tractrix), starting as on the circle
/// through the first three points. Drops curvatures, which belong to the other curve; keeps speeds.
PathPoints AtRearAxle(PathPoints given, double ahead);

/// Fits a path through or along the points.
///
/// A Path has a continuous heading, so each corner of a polyline becomes an arc of at most 2 mm,
/// within 1 mm of the corner and far too tight for any car.
///
/// A spline has degree 5 over the chord length u, with a knot at every point, and minimizes
///     sum over i of w_i |P(u_i) - p_i|^2 + l^6 integral of |P'''(u)|^2 du,
/// where w_i [m] is the length of path that point i represents, and l [m] the smoothing length,
/// below which details are smoothed out (Reinsch 1967; here with the third derivative, which favors
/// slow steering among smooth paths). l is the largest value that keeps within max_deviation, found
/// by bisection to 10 %. Curvature and curvature rate are continuous. P''' is 0 at the ends: there
/// the curvature rate falls to 0 over about two points or l, whichever is longer, and is up to a
/// tenth too large next to that.
///
/// Guarantees: no point lies further than max_deviation from the path's point at its station, as
/// measured on the path itself; with `resample`, this holds for the resampled points on the
/// straight lines. Between distant points a spline bulges, next to corners by a tenth of their
/// distance and more: see `bulge`. It keeps within a fifth of their distance, or within the arc
/// that turns with them. Does not account for obstacles or the limits of a car.
///
/// Errors: InputError naming the first point whose heading is opposite to the direction of travel;
/// for fewer than two different points; for more than 200 000 points to be fitted; for more than
/// kMaxPathLength, naming the largest gap; for a deviation that cannot be met; and for a spline
/// that swings farther aside, naming the point that is probably wrong. PreconditionError for
/// numbers that are not finite and lists of different lengths. Cost of a spline: about 0.2 ms per
/// point and 30 us per meter, 1 kB per point and 1 kB per meter.
FittedPath FitPath(PathPoints given, const PathFitOptions& options);

}  // namespace trackbed
