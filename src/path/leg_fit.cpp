#include "src/path/leg_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/path/spline_fit.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/geometry/pose.h"

// Fits a path to the points of one leg. FitLeg removes repeated points, and optionally resamples
// the distinct points along straight lines. The file spline_fit.cpp contains the fit of splines. A
// polyline fit joins straight lines by arcs with tangents of at most 1 mm. Points at which the path
// turns back are reported as reversals.

namespace trackbed {
namespace {

/// Fits a path that consists of straight lines joined by tiny arcs.
void FitPolyline(const ChordPoints& chords, double period, FittedPath& fitted,
                 std::vector<double>& stations) {
  constexpr double kTangent = 1e-3;  // [m]
  const std::size_t count = chords.points.size();
  std::vector<double> angles(count, 0.0);
  std::vector<double> tangents(count, 0.0);
  ForEachTurn(chords, period, [&](std::size_t i, double angle, double shorter) {
    // Skip the start point, because a path has no corner at its start, even if it is closed.
    const bool is_start = i == 0;
    if (std::abs(angle) > kEqualityTolerance && !is_start) {
      angles[i] = angle;
      tangents[i] = std::min(kTangent, 0.25 * shorter);
    }
  });
  const Vec2 first = chords.points[1] - chords.points[0];
  std::vector<Segment> segments;
  double s = 0.0;
  stations.assign(count, 0.0);
  const std::size_t lines = period > 0.0 ? count : count - 1;
  for (std::size_t i = 0; i < lines; ++i) {
    const std::size_t next = (i + 1) % count;
    const double length = (chords.points[next] - chords.points[i]).norm();
    segments.push_back({.length = length - tangents[i] - tangents[next]});
    s += segments.back().length;
    if (next == 0) {
      continue;
    }
    const double angle = std::abs(angles[next]);
    const double radius = angle > 0.0 ? tangents[next] / std::tan(0.5 * angle) : 0.0;
    const double arc = radius * angle;
    stations[next] = s + 0.5 * arc;
    if (angle > 0.0) {
      segments.push_back({.length = arc, .curvature = std::copysign(1.0 / radius, angles[next])});
      fitted.jumps.push_back({.point = next,
                              .s = stations[next],
                              .position = chords.points[next],
                              .angle = angles[next],
                              .rounded = {s, s + arc}});
    }
    s += arc;
  }
  fitted.path = Path({chords.points[0].x(), chords.points[0].y(), std::atan2(first.y(), first.x())},
                     std::move(segments));
  if (period > 0.0) {
    stations.push_back(fitted.path.length());
  }
}

/// Inserts a point after the first point, so that a polyline leaves the first point with the given
/// heading.
void BeginWithHeading(ChordPoints& chords, double heading) {
  constexpr double kLength = 1e-3;  // [m]
  const Vec2 first = chords.points[1] - chords.points[0];
  const double turn = AngleDifference(std::atan2(first.y(), first.x()), heading);
  if (std::abs(turn) <= kEqualityTolerance) {
    return;
  }
  const double length = std::min(kLength, 0.25 * first.norm());
  chords.points.insert(chords.points.begin() + 1, chords.points[0] + length * Direction(heading));
  chords.u.insert(chords.u.begin() + 1, length);
}

/// Returns whether the straight line between two points has the prescribed headings.
bool IsStraight(const ChordPoints& chords, const EndHeadings& headings) {
  const Vec2 line = chords.points.back() - chords.points.front();
  const double yaw = std::atan2(line.y(), line.x());
  const auto fits = [&](const std::optional<double>& heading) {
    return !heading || std::abs(AngleDifference(*heading, yaw)) <= kEqualityTolerance;
  };
  return chords.points.size() == 2 && fits(headings.begin) && fits(headings.end);
}

}  // namespace

DistinctPoints DistinctFor(const PathPoints& given, const PathFitOptions& options) {
  // Diagonal of the box within which points count as noise, as a fraction of the largest deviation.
  // All points in a noise box are at most half of the box's diagonal away from its center. In a
  // noise box at an end of the path, the points are at most the diagonal away from the path's end.
  constexpr double kNoise = 0.9;
  return Distinct(given, options.closed,
                  options.fit == PathFit::kSpline ? kNoise * options.max_deviation : 0.0);
}

std::vector<HeadingJump> FindReversals(const ChordPoints& chords, double period) {
  std::vector<HeadingJump> reversals;
  ForEachTurn(chords, period, [&](std::size_t i, double angle, double /*shorter*/) {
    if (std::abs(angle) > kMaxHeadingJump) {
      reversals.push_back({.point = i,
                           .s = chords.u[i],
                           .position = chords.points[i],
                           .angle = angle,
                           .rounded = {chords.u[i], chords.u[i]}});
    }
  });
  return reversals;
}

ChordPoints KnotsOf(const DistinctPoints& distinct, const PathFitOptions& options) {
  if (options.resample) {
    return Resampled(distinct, *options.resample);
  }
  // The linear equations of a spline lose a digit for each factor of about 1.6 between the
  // distances of neighboring knots. Points much closer together than their neighbors would
  // therefore make the spline oscillate, so they are no knots. The fitted spline still stays within
  // max_deviation of points that are not knots.
  constexpr double kSpacing = 0.1;
  return options.fit == PathFit::kSpline ? Spaced(distinct, kSpacing * options.max_deviation)
                                         : distinct.chords;
}

FittedPath FitLeg(PathPoints given, const PathFitOptions& options, const EndHeadings& headings,
                  double max_curvature) {
  const DistinctPoints distinct = DistinctFor(given, options);
  FittedPath fitted;
  fitted.given = std::move(given);
  fitted.options = options;
  const std::size_t count = distinct.chords.points.size();
  if (count < 2 || (options.closed && count < 3)) {
    FailFit("", fmt::format("{} different point{}; must be at least {}", count,
                            count == 1 ? "" : "s", options.closed ? 3 : 2));
  }
  CheckLength(distinct, fitted.given);
  fitted.repeated = distinct.repeated;
  fitted.merged = distinct.merged;
  ChordPoints own = KnotsOf(distinct, options);
  if (own.points.size() > kMaxFittedPoints) {
    FailFit("resample",
            fmt::format("{} points; must be at most {}, give a distance to resample them",
                        own.points.size(), kMaxFittedPoints));
  }
  const auto name_points = [&](std::vector<HeadingJump>& jumps) {
    for (HeadingJump& jump : jumps) {
      jump.point = distinct.number[LastBefore(distinct.chords.u, own.u[jump.point])];
    }
  };
  fitted.reversals = FindReversals(own, distinct.period);
  if (!fitted.reversals.empty()) {
    name_points(fitted.reversals);
    return fitted;
  }
  std::vector<double> stations;  // stations of the distinct points
  if (options.fit == PathFit::kSpline && !IsStraight(own, headings)) {
    FitSpline(own, distinct, headings, max_curvature, fitted, stations);
  } else {
    const std::size_t knots = own.points.size();
    if (headings.begin) {
      BeginWithHeading(own, *headings.begin);
    }
    std::vector<double> own_stations;
    FitPolyline(own, distinct.period, fitted, own_stations);
    if (options.resample) {
      for (std::size_t i = 0; i < count; ++i) {
        const Vec2& point = distinct.chords.points[i];
        const double about = distinct.chords.u[i];
        stations.push_back(
            fitted.path
                .Project({point.x(), point.y(), 0.0},
                         {about - 2.0 * *options.resample, about + *options.resample})
                .s);
      }
    } else {
      stations = std::move(own_stations);
      stations.erase(stations.begin() + 1,
                     stations.begin() + 1 + static_cast<std::ptrdiff_t>(own.points.size() - knots));
    }
    name_points(fitted.jumps);
  }
  // A repeated point gets the station of its predecessor. The last point of a closed path gets the
  // station of the path's end.
  for (const double u : distinct.given_u) {
    const std::size_t i = LastBefore(distinct.chords.u, u);
    fitted.stations.push_back(u > distinct.chords.u[i] ? fitted.path.length() : stations[i]);
  }
  return fitted;
}

}  // namespace trackbed
