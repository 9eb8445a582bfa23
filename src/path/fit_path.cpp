#include "trackbed/path/fit_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "src/path/points_to_fit.h"
#include "src/path/spline_fit.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

// Fits a path to points. FitPath drops repeated points, and optionally resamples the other points
// along straight lines. A spline fit is in spline_fit.cpp. A polyline fit joins straight lines by
// arcs with tangents of at most 1 mm. Points at which the path turns back are reported as
// reversals.

namespace trackbed {
namespace {

/// Finds the distinct points of the given points. A polyline passes all points, so it has no noise.
DistinctPoints DistinctFor(const PathPoints& given, const PathFitOptions& options) {
  // The points within a box of noise are nearer to its center than half of this share of the
  // deviation, and points at the ends are nearer to the end than this share.
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

/// Returns the points to which the path is fitted.
ChordPoints KnotsOf(const DistinctPoints& distinct, const PathFitOptions& options) {
  return options.resample ? Resampled(distinct, *options.resample) : distinct.chords;
}

/// Fits a path that consists of straight lines joined by tiny arcs.
void FitPolyline(const ChordPoints& chords, double period, FittedPath& fitted,
                 std::vector<double>& stations) {
  constexpr double kTangent = 1e-3;  // [m]
  const std::size_t count = chords.points.size();
  std::vector<double> angles(count, 0.0);
  std::vector<double> tangents(count, 0.0);
  ForEachTurn(chords, period, [&](std::size_t i, double angle, double shorter) {
    // The path has no corner at its start, even if the path is closed.
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

void CheckArguments(const PathPoints& given, const PathFitOptions& options) {
  TRACKBED_REQUIRE(
      std::isfinite(options.max_deviation) && options.max_deviation > 0.0 &&
          (!options.resample || (std::isfinite(*options.resample) && *options.resample > 0.0)),
      "FitPath: max_deviation {} m, resample {} m; must be above 0", options.max_deviation,
      options.resample.value_or(1.0));
  for (const Vec2& point : given.points) {
    TRACKBED_REQUIRE(point.allFinite(), "FitPath: a point at ({}, {})", point.x(), point.y());
  }
  TRACKBED_REQUIRE(given.lines.empty() || given.lines.size() == given.points.size(),
                   "FitPath: {} lines for {} points", given.lines.size(), given.points.size());
  for (const auto* list : {&given.yaw, &given.curvature, &given.speed}) {
    TRACKBED_REQUIRE(list->empty() || list->size() == given.points.size(),
                     "FitPath: {} entries for {} points", list->size(), given.points.size());
    for (const double number : *list) {
      TRACKBED_REQUIRE(std::isfinite(number), "FitPath: an entry {}", number);
    }
  }
}

/// Returns the largest difference between the given headings and the headings of the path [rad].
double HeadingDifference(const FittedPath& fitted) {
  // Heading difference [rad] up to which the given headings may refer to another axis of the car.
  constexpr double kOpposite = 2.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < fitted.given.yaw.size(); ++i) {
    const double yaw = fitted.path.At(fitted.stations[i]).pose.yaw;
    const double own = std::abs(AngleDifference(fitted.given.yaw[i], yaw));
    if (own > kOpposite) {
      const Vec2& point = fitted.given.points[i];
      FailFit("",
              fmt::format("the heading of point {} at ({:.6g}, {:.6g}), {:.4g} rad, is against the "
                          "direction of travel, {:.4g} rad; paths that are driven in reverse are "
                          "not supported",
                          i + 1, point.x(), point.y(), fitted.given.yaw[i], WrapAngle(yaw)),
              LineOf(fitted.given, i));
    }
    largest = std::max(largest, own);
  }
  return largest;
}

/// Fits a path as FitPath does, without a search for a larger deviation if the fit fails.
FittedPath FitOnce(PathPoints given, const PathFitOptions& options) {
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
  const ChordPoints own = KnotsOf(distinct, options);
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
  if (options.fit == PathFit::kSpline && own.points.size() > 2) {
    FitSpline(own, distinct, fitted, stations);
  } else {
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
    }
    name_points(fitted.jumps);
  }
  // A repeated point gets the station of its predecessor. The last point of a closed path gets the
  // station of the path's end.
  for (const double u : distinct.given_u) {
    const std::size_t i = LastBefore(distinct.chords.u, u);
    fitted.stations.push_back(u > distinct.chords.u[i] ? fitted.path.length() : stations[i]);
    const std::size_t point = fitted.stations.size() - 1;
    const Vec2 at = fitted.path.At(fitted.stations.back()).pose.position();
    const double deviation = (at - fitted.given.points[point]).norm();
    if (deviation > fitted.deviation) {
      fitted.deviation = deviation;
      fitted.deviation_point = point;
    }
  }
  fitted.heading_difference = HeadingDifference(fitted);
  return fitted;
}

/// Returns a number above 0, rounded up to two digits.
double RoundedUp(double number) {
  const double unit = std::pow(10.0, std::floor(std::log10(number)) - 1.0);
  return unit * std::ceil(number / unit - 1e-9);
}

/// Returns a largest deviation of about the smallest size with which a spline can be fitted [m].
/// Returns nullopt if it exceeds a tenth of the length of the points, or after kMaxFits failures.
std::optional<double> NoiseDeviation(const PathPoints& given, const PathFitOptions& options) {
  constexpr double kStep = 1.1;
  constexpr int kMaxFits = 8;
  int fits = 0;
  const double length = Distinct(given, options.closed, 0.0).chords.u.back();
  PathFitOptions spline = options;
  spline.fit = PathFit::kSpline;
  double allowed =
      options.fit == PathFit::kSpline ? kStep * spline.max_deviation : kEqualityTolerance;
  for (; allowed <= 0.1 * length && fits < kMaxFits; allowed *= kStep) {
    spline.max_deviation = RoundedUp(allowed);
    const DistinctPoints distinct = DistinctFor(given, spline);
    if (distinct.chords.points.size() < 2 || distinct.chords.u.back() > kMaxPathLength ||
        !FindReversals(KnotsOf(distinct, spline), distinct.period).empty()) {
      continue;
    }
    ++fits;
    try {
      static_cast<void>(FitOnce(given, spline));
      return spline.max_deviation;
    } catch (const InputError&) {
      continue;
    }
  }
  return std::nullopt;
}

}  // namespace

PathPoints AtRearAxle(PathPoints given, double ahead) {
  TRACKBED_REQUIRE(std::isfinite(ahead), "AtRearAxle: a point {} m ahead", ahead);
  if (ahead == 0.0) {
    return given;
  }
  given.curvature.clear();
  if (!given.yaw.empty()) {
    for (std::size_t i = 0; i < given.points.size(); ++i) {
      given.points[i] -= ahead * Vec2(std::cos(given.yaw[i]), std::sin(given.yaw[i]));
    }
    return given;
  }
  const ChordPoints chords = Distinct(given, false, 0.0).chords;
  if (chords.points.size() < 2) {
    return given;
  }
  const auto direction = [&](std::size_t i) {
    const Vec2 along = chords.points[i + 1] - chords.points[i];
    return std::atan2(along.y(), along.x());
  };
  double yaw = direction(0);
  if (chords.points.size() > 2) {
    const double turn = AngleDifference(direction(1), direction(0));
    const double curvature = 2.0 * std::sin(turn) / (chords.points[2] - chords.points[0]).norm();
    // The initial yaw is relative to the tangent at the first point. The direction of the tangent
    // differs from the direction of the first chord by half of the turn along the chord.
    yaw -= 0.5 * curvature * chords.u[1] + std::asin(std::clamp(ahead * curvature, -1.0, 1.0));
  }
  Vec2 before = given.points.front();
  for (Vec2& point : given.points) {
    const Vec2 along = point - before;
    before = point;
    if (along.norm() > kEqualityTolerance) {
      // Let phi be the angle between the car's yaw and a straight line of length d. Along the line,
      // tan(phi/2) decreases by the factor exp(-d/ahead).
      const double line = std::atan2(along.y(), along.x());
      const double angle = AngleDifference(line, yaw);
      yaw = line - 2.0 * std::atan(std::tan(0.5 * angle) * std::exp(-along.norm() / ahead));
    }
    point -= ahead * Vec2(std::cos(yaw), std::sin(yaw));
  }
  return given;
}

FittedPath FitPath(PathPoints given, const PathFitOptions& options) {
  CheckArguments(given, options);
  try {
    FittedPath fitted = FitOnce(given, options);
    if (!fitted.reversals.empty()) {
      fitted.noise_deviation = NoiseDeviation(given, options);
    }
    return fitted;
  } catch (const InputError& error) {
    // Noise that turns back may be too large for a spline, although no point is a reversal.
    std::vector<Problem> problems = error.problems();
    if (problems.front().key == "max_deviation" && DistinctFor(given, options).merged > 0) {
      if (const std::optional<double> allowed = NoiseDeviation(given, options)) {
        problems.front().message += fmt::format(
            "; the points turn back, as noise of the positions does: use at least {:.2g}",
            *allowed);
      }
    }
    throw InputError(std::move(problems));
  }
}

}  // namespace trackbed
