#include "trackbed/path/fit_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "src/path/fit_once.h"
#include "src/path/leg_fit.h"
#include "src/path/legs.h"
#include "src/path/points_to_fit.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/path/tractrix.h"

// Repeats a path fit that fails because of noise with growing values of max_deviation. The error
// message of the failed fit states a value of max_deviation with which the fit succeeds. The file
// fit_once.cpp contains a single fit of a path.
namespace trackbed {
namespace {

/// Rounds a number above 0 up to two significant digits.
double RoundedUp(double number) {
  const double unit = std::pow(10.0, std::floor(std::log10(number)) - 1.0);
  return unit * std::ceil(number / unit - 1e-9);
}

/// Returns approximately the smallest value of max_deviation with which a spline can be fitted [m].
/// NoiseDeviation returns nullopt if this deviation exceeds a tenth of the length of the points, or
/// after kMaxFits failed fits.
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
    const PathPoints points = AtStandstills(given, spline.max_deviation);
    const std::vector<Leg> legs = FindLegs(points, spline.max_deviation);
    const bool can_fit = std::all_of(legs.begin(), legs.end(), [&](const Leg& leg) {
      const DistinctPoints distinct = DistinctFor(PointsOf(points, leg), spline);
      return distinct.chords.points.size() > 1 && distinct.chords.u.back() <= kMaxPathLength &&
             FindReversals(KnotsOf(distinct, spline), distinct.period).empty();
    });
    if (!can_fit) {
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
  const auto reverse = std::find(given.direction.begin(), given.direction.end(), -1);
  if (reverse != given.direction.end()) {
    const auto point = static_cast<std::size_t>(reverse - given.direction.begin());
    FailFit("ahead",
            fmt::format("{} is driven in reverse, so the path of the rear axle needs headings; add "
                        "a column of headings, or give points of the rear axle and remove ahead",
                        NameOf(given, point)));
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
    // Compute the initial yaw from the path's tangent at the first point. The tangent differs from
    // the first chord by half of the turn along this chord.
    yaw -= 0.5 * curvature * chords.u[1] + std::asin(std::clamp(ahead * curvature, -1.0, 1.0));
  }
  Vec2 before = given.points.front();
  for (Vec2& point : given.points) {
    const Vec2 along = point - before;
    before = point;
    if (along.norm() > kEqualityTolerance) {
      yaw = YawAlongTractrix(yaw, along, ahead);
    }
    point -= ahead * Vec2(std::cos(yaw), std::sin(yaw));
  }
  return given;
}

FittedPath FitPathWithin(PathPoints given, const PathFitOptions& options, double max_curvature) {
  TRACKBED_REQUIRE(max_curvature > 0.0, "FitPathWithin: a curvature of {} 1/m; must be above 0",
                   max_curvature);
  CheckFitArguments(given, options);
  return FitOnce(std::move(given), options, max_curvature);
}

FittedPath FitPath(PathPoints given, const PathFitOptions& options) {
  CheckFitArguments(given, options);
  try {
    FittedPath fitted = FitOnce(given, options);
    if (!fitted.reversals.empty()) {
      fitted.noise_deviation = NoiseDeviation(given, options);
    }
    return fitted;
  } catch (const InputError& error) {
    // A spline fit may fail because noise makes the positions move backward, even if no point is
    // reported as a reversal.
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
