#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/path.h"

/// Paths through points that another program planned.
namespace trackbed {

/// Points of a path in the order of travel. Lists other than the points are empty or have an entry
/// for each point.
struct PathPoints {
  std::vector<Vec2> points;       ///< of the rear-axle center [m]
  std::vector<double> yaw;        ///< heading of the car [rad]
  std::vector<double> curvature;  ///< positive to the left [1/m]
  std::vector<double> speed;      ///< [m/s], >= 0
};

/// What becomes of the points.
enum class PathFit {
  kPolyline,  ///< straight lines from point to point; headings jump where they meet
  kSpline,    ///< the smoothest spline that keeps within max_deviation of every point
};

struct PathFitOptions {
  PathFit fit = PathFit::kSpline;
  double max_deviation = 0.05;       ///< of a spline from the points [m], > 0
  bool closed = false;               ///< whether the path leads back to its first point
  std::optional<double> resample{};  ///< distance of the points that are fitted [m]; none: as given
};

/// A point at which the direction of travel changes at once.
struct HeadingJump {
  std::size_t point = 0;       ///< its number among the points, from 0
  double s = 0.0;              ///< station [m]
  Vec2 position{0.0, 0.0};     ///< [m]
  double angle = 0.0;          ///< change of direction, positive to the left [rad]
  Stations rounded{0.0, 0.0};  ///< what the path has in its place: an arc [m]
};

/// A path, and what was done to the points.
struct FittedPath {
  PathPoints given;
  PathFitOptions options;
  Path path;
  std::vector<double> stations;     ///< of each point [m]
  double deviation = 0.0;           ///< largest distance of a point from its station [m]
  std::size_t deviation_point = 0;  ///< where
  std::size_t repeated = 0;         ///< points that equal the one before, which were left out
  std::vector<HeadingJump> jumps;   ///< of a polyline, of more than 1e-9 rad
  /// Where the path turns back on itself, by more than kLargestJump: then there is no path.
  std::vector<HeadingJump> reversals;
  double smoothing_length = 0.0;    ///< l of a spline [m]; 0 of a polyline
  double heading_difference = 0.0;  ///< largest one of the given headings from the path's [rad]
};

/// A path whose direction of travel changes by more than this at a point turns back on itself, and
/// cannot be fitted [rad].
inline constexpr double kLargestJump = 2.8;

/// The points of the rear-axle center of a car whose point `ahead` [m] of it on the car's axis
/// leads through the given ones, such as the center of gravity. With headings exactly; without, the
/// rear axle is drawn along without slip (a tractrix), and starts as it would on the circle through
/// the first three points. Curvatures are left out, which are those of the other curve; speeds
/// stay.
PathPoints AtRearAxle(PathPoints given, double ahead);

/// The path through or along the points.
///
/// A polyline has an arc of at most 2 mm in place of each jump of the heading, because a Path is
/// continuous in its heading: within 1 mm of the corner, and far too tight for any car.
///
/// A spline is of degree 5 over the chord length u, with a knot at every point, and minimizes
///   sum over i of w_i |P(u_i) - p_i|^2 + l^6 integral of |P'''(u)|^2 du,
/// w_i [m] being the length of path that point i stands for and l [m] the smoothing length, below
/// which details are smoothed out (Reinsch 1967, with the third derivative: of smooth paths, those
/// that turn the steering least). l is the largest that was found, by bisection to 10 %, to keep
/// within max_deviation. Its curvature and curvature rate are continuous. Where it ends, P''' is 0:
/// the curvature rate there falls to 0, over about two points or l, whichever is longer, and is up
/// to a tenth too large beside.
///
/// Guarantees: no point lies further than max_deviation from the path's point at its station, which
/// is measured on the path itself; and with `resample` no point of those on the straight lines.
/// Between points far apart a spline bulges, beside corners by a tenth of their distance and more.
/// Does not keep clear of obstacles, nor within what a car can drive.
///
/// Errors: InputError naming the first point whose heading is opposite to the direction of travel,
/// for fewer than two different points, more than 200 000 to be fitted, and a deviation that cannot
/// be kept; PreconditionError for numbers that are not finite and lists of different lengths. Cost
/// of a spline: about 0.2 ms a point.
FittedPath FitPath(PathPoints given, const PathFitOptions& options);

}  // namespace trackbed
