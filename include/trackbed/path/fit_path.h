#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/path.h"

/// Fits smooth paths to points that another program has planned.
namespace trackbed {

/// Points of a path in the order of travel. Every list except `points` either is empty or has one
/// entry per point.
struct PathPoints {
  std::vector<Vec2> points;  ///< Positions of the rear-axle center [m].
  std::vector<double> yaw;   ///< Headings of the car at the points [rad].
  /// Curvatures of the path at the points, positive to the left [1/m].
  std::vector<double> curvature;
  std::vector<double> speed;  ///< Speeds of the car at the points [m/s], >= 0, in both gears.
  /// Line numbers of the points in the file, from 1, for error messages.
  std::vector<int> lines{};
  /// Directions of motion at the points: +1 forwards, -1 backwards, 0 unknown, for example where
  /// the car stands. If this list of directions is empty, the directions of motion follow from the
  /// headings.
  std::vector<int> direction{};
  /// Times at which the car is at the points [s], strictly increasing; only differences matter.
  std::vector<double> time{};
};

/// The method by which a path is fitted to points.
enum class PathFit {
  kPolyline,  ///< Straight lines between the points, with corners at the points.
  kSpline,    ///< The smoothest spline that stays within max_deviation of every point.
};

struct PathFitOptions {
  PathFit fit = PathFit::kSpline;
  double max_deviation = 0.05;  ///< Maximum allowed distance of a spline from the points [m], > 0.
  /// Whether the path is closed, that is, whether the path returns to the first point.
  bool closed = false;
  /// Spacing of the points after resampling, before the fit [m]; nullopt: the given points are not
  /// resampled.
  std::optional<double> resample{};
};

/// A jump of the direction of travel at one of the points to which the path is fitted.
struct HeadingJump {
  std::size_t point = 0;    ///< Index of the point at which the direction jumps, from 0.
  double s = 0.0;           ///< Station at which the direction jumps [m].
  Vec2 position{0.0, 0.0};  ///< Position at which the direction jumps [m].
  /// Change of the direction of travel at the point, positive to the left [rad].
  double angle = 0.0;
  Stations rounded{0.0, 0.0};  ///< Start and end station of the arc that replaces the corner [m].
};

/// A path that was fitted to points, and measures of the quality of the fit.
struct FittedPath {
  PathPoints given;
  PathFitOptions options;
  Path path;
  std::vector<double> stations;  ///< Station of each point on the fitted path [m].
  /// Largest distance between a point and the fitted path at the point's station [m].
  double deviation = 0.0;
  std::size_t deviation_point = 0;  ///< Index of the point with the largest deviation.
  /// Largest distance of the spline from the straight lines between neighboring points [m].
  double bulge = 0.0;
  /// Station at the start of the straight line from which the spline is furthest away [m].
  double bulge_station = 0.0;
  /// Number of points that were dropped because they equal the preceding point.
  std::size_t repeated = 0;
  /// Number of points that were merged with their neighbors, because the polyline turns back at
  /// these points within max_deviation.
  std::size_t merged = 0;
  /// Number of points that were added on straight lines between the given points. Without the added
  /// points, a spline would deviate too far from the straight lines.
  std::size_t added = 0;
  /// Corners of a polyline at which the direction changes by more than 1e-9 rad.
  std::vector<HeadingJump> jumps;
  /// Points at which the direction of travel changes by more than kMaxHeadingJump. No path is
  /// fitted if the list `reversals` is not empty.
  std::vector<HeadingJump> reversals;
  /// If `reversals` is not empty: about the smallest max_deviation with which a spline can be
  /// fitted [m]. `noise_deviation` is nullopt if it would exceed a tenth of the length of the
  /// points, or if the search for the value needs too many fits.
  std::optional<double> noise_deviation{};
  /// Smoothing length l of the fitted spline [m]; 0 for a polyline, and for a path that follows the
  /// given headings and curvatures.
  double smoothing_length = 0.0;
  /// Largest difference between a given heading and the heading of the fitted path [rad].
  double heading_difference = 0.0;
};

/// Maximum length of a path that can be fitted, measured along the straight lines between the
/// points [m].
inline constexpr double kMaxPathLength = 200e3;

/// Maximum change of the direction of travel at a point for which a path can be fitted [rad].
inline constexpr double kMaxHeadingJump = 2.8;

/// Converts the path of a reference point of the car, such as the center of gravity, to the path of
/// the rear-axle center. The reference point lies on the car's longitudinal axis, `ahead` [m] in
/// front of the rear axle. The conversion to the rear-axle path is exact if headings are given.
/// Without headings, the conversion assumes that the rear axle follows the reference point without
/// slip (a tractrix) and starts on the circle through the first three points. The conversion keeps
/// the speeds, but drops the given curvatures, which are those of the reference point's path.
/// Throws InputError if the car drives in reverse and no headings are given, because the motion of
/// an axle behind a given point is unstable in reverse.
PathPoints AtRearAxle(PathPoints given, double ahead);

/// Fits a path through or along the points.
///
/// The points are divided into legs, each driven in one direction of motion. The legs follow from
/// the directions of motion at the points (+1 forwards, -1 backwards). Where the directions of
/// motion are unknown, the legs follow from the headings. The car drives in reverse where its
/// heading is opposite to the step to the next point. A leg that is shorter than max_deviation
/// counts as noise of the points. The car changes its direction of motion only at some of the
/// points, which are the cusps of the path. Each leg of the path is fitted as a separate curve. At
/// a cusp, the heading is continuous. The heading at a cusp is the given heading, corrected by the
/// mean difference between curves and given headings. Without suitable given headings, the heading
/// at a cusp is the mean of the headings of the two curves. The curvature may jump at a cusp, where
/// the car stands. Points without given directions and headings are fitted as one leg that is
/// driven forwards.
///
/// Because a Path has a continuous heading, each corner of a polyline becomes an arc. The arc that
/// replaces a corner is at most 2 mm long, lies within 1 mm of the corner, and is far too tight for
/// any car.
///
/// A spline is fitted in two steps. First, a quintic spline P(u) over the chord length u, with a
/// knot at every point p_i, minimizes
///     sum over i of w_i |P(u_i) - p_i|^2 + l^6 integral of |P'''(u)|^2 du,
/// where w_i [m] is the length of path that point i represents, and l [m] is the smoothing length.
/// Details of the points that are shorter than the smoothing length l are smoothed out (Reinsch
/// 1967). Bisection finds, to 10 %, the largest smoothing length l for which the deviation of the
/// points is at most max_deviation. Second, Newton's method, which starts at the quintic spline,
/// minimizes over all curves
///     sum over i of w_i n_i^2 + l^6 integral of (kappa'(s) - c)^2 ds,
/// where n_i [m] is the distance of point i from the curve, kappa' is the curvature rate, and c is
/// its mean: a minimum variation curve (Moreton and Séquin 1992). The integral of (kappa'(s) - c)^2
/// is 0 for lines, arcs and clothoids, so points on a line, arc or clothoid are fitted by exactly
/// this curve. The fitted curve has a continuous curvature and a continuous curvature rate. If the
/// deviation of the curve exceeds max_deviation, the smoothing length l is reduced. If Newton's
/// method finds no curve within max_deviation, the path is the quintic spline itself.
///
/// If headings and curvatures of an open path agree with the points as exactly as a planner's own
/// output, no spline is fitted: the path has these headings and curvatures. If the curvature is
/// constant before a step between two points, and has another constant value after the step, the
/// curvature jumps within the step.
///
/// Steps that turn back by more than a right angle within max_deviation count as noise, for example
/// the noise of a recorder in a standing car. Noisy points are merged into groups, and a spline is
/// fitted to the centers of the groups. Successive points with the speed 0 are fitted as one point
/// if they lie within max_deviation of one place; FittedPath::given then contains only this place.
///
/// Guarantees: each leg of an open path begins at the leg's first point and ends at the leg's last
/// point, to 1e-9 m. At coordinates of 1e6 m and more, the ends of the path are exact to the
/// rounding error of the coordinates. If all points lie on one line, arc or clothoid, the path
/// deviates from this curve by at most 1e-9 m. No point lies further than max_deviation from the
/// path's point at the same station, as measured on the fitted path. With `resample`, the deviation
/// is measured from the resampled points on the straight lines between the given points. Between
/// widely spaced points, a spline deviates from the straight lines (`bulge`); next to corners, the
/// deviation is a tenth of the spacing or more. The deviation `bulge` of a spline from the straight
/// lines is at most the larger of two values: a fifth of the spacing, and the height of an arc that
/// turns by the same angle as the points. The fit does not account for obstacles or the limits of a
/// car.
///
/// A long step between two points counts as a straight line: a step that is more than four times as
/// long as the median step, and has less than a quarter of the curvature beside it. A step between
/// two points also counts as a straight line if the spline would exceed the bound of `bulge` on the
/// step, and the points turn by at most 45 degrees at both ends of the step. On steps that count as
/// straight lines, points are added (`added`), and the spline stays within max_deviation of the
/// added points.
///
/// Throws InputError if there are fewer than two different points or more than 200 000 points to be
/// fitted, or if no spline stays within max_deviation. Throws InputError if the heading of a point
/// contradicts the directions of motion; the message names the first such point. Throws InputError
/// if a closed path has cusps. Throws
/// InputError if the path is longer than kMaxPathLength; the message names the largest gap between
/// points. Throws InputError if a spline deviates more than guaranteed from the straight lines; the
/// message names the point that is probably wrong. Throws PreconditionError if a number is not
/// finite or the lists have different lengths. Fitting a spline takes about 0.8 ms and 3 kB per
/// point.
FittedPath FitPath(PathPoints given, const PathFitOptions& options);

/// Fits a path to the points as FitPath does, with a bound on the curvature of a spline. Where the
/// curvature of the points jumps, for example where a line joins an arc, the curve of FitPath
/// exceeds the curvature of the arc by up to 6 %. FitPathWithin spreads a jump of the curvature
/// over a longer part of the curve, within PathFitOptions::max_deviation. A car can drive the
/// resulting curve even on an arc near the smallest radius that the car can steer.
///
/// Guarantees: the same as FitPath. The curvature of the path is at most `max_curvature` [1/m],
/// with a relative tolerance of 1e-3, if a curve of least variation with this bound stays within
/// max_deviation of the points. The caller must check the path, because the curvature may exceed
/// the bound if no curve within max_deviation meets the bound. The curvature bound has no effect on
/// a polyline, or on a path with the headings and curvatures of the points.
///
/// Throws InputError in the same cases as FitPath, and PreconditionError unless max_curvature > 0.
FittedPath FitPathWithin(PathPoints given, const PathFitOptions& options, double max_curvature);

}  // namespace trackbed
