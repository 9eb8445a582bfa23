#include "src/path/fit_once.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "src/path/given_shape.h"
#include "src/path/least_variation.h"
#include "src/path/leg_fit.h"
#include "src/path/legs.h"
#include "src/path/points_to_fit.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/geometry/pose.h"

// Fits a path to points. The points are divided into legs of one direction of motion (legs.cpp).
// Each leg between cusps is fitted as a forward path in its direction of travel (leg_fit.cpp). A
// first fit of each leg gives the headings at the cusps between the legs. A second fit, with the
// headings of the first fit at the ends of the legs, makes the heading of the whole path
// continuous. If the given headings and curvatures agree with the points, the path follows the
// given shape instead of a fit (given_shape.cpp).

namespace trackbed {

void CheckFitArguments(const PathPoints& given, const PathFitOptions& options) {
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
  TRACKBED_REQUIRE(given.direction.empty() || given.direction.size() == given.points.size(),
                   "FitPath: {} directions for {} points", given.direction.size(),
                   given.points.size());
  for (const int direction : given.direction) {
    TRACKBED_REQUIRE(std::abs(direction) <= 1, "FitPath: a direction {}", direction);
  }
  for (const auto* list : {&given.yaw, &given.curvature, &given.speed, &given.time}) {
    TRACKBED_REQUIRE(list->empty() || list->size() == given.points.size(),
                     "FitPath: {} entries for {} points", list->size(), given.points.size());
    for (const double number : *list) {
      TRACKBED_REQUIRE(std::isfinite(number), "FitPath: an entry {}", number);
    }
  }
}

namespace {

/// Returns the largest difference between the headings given with the points and the headings of
/// the fitted path [rad].
double HeadingDifference(const FittedPath& fitted) {
  // Heading difference [rad] up to which the given headings may refer to another axis of the car.
  constexpr double kOpposite = 2.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < fitted.given.yaw.size(); ++i) {
    const double yaw = fitted.path.At(fitted.stations[i]).pose.yaw;
    const double own = std::abs(AngleDifference(fitted.given.yaw[i], yaw));
    if (own > kOpposite) {
      const Vec2& point = fitted.given.points[i];
      const bool is_reverse = fitted.path.At(fitted.stations[i]).direction < 0;
      FailFit("",
              fmt::format("the heading of point {} at ({:.6g}, {:.6g}), {:.4g} rad, is opposite to "
                          "{:.4g} rad, the heading of a car that drives {} there as {}",
                          i + 1, point.x(), point.y(), fitted.given.yaw[i], WrapAngle(yaw),
                          is_reverse ? "in reverse" : "forwards",
                          fitted.given.direction.empty()
                              ? "at the points around it; correct the heading, or remove the "
                                "column of headings"
                              : "the file's directions of motion say; correct the headings or the "
                                "directions, or remove one of their columns"),
              LineOf(fitted.given, i));
    }
    largest = std::max(largest, own);
  }
  return largest;
}

/// Converts the heading `travel` of a leg's direction of travel to the heading of the car.
double CarHeading(double travel, int direction) {
  return direction > 0 ? travel : WrapAngle(travel + kPi);
}

/// Returns the weighted mean of angles that are close to each other [rad]. All weights are above 0.
double MeanAngle(const std::vector<double>& angles, const std::vector<double>& weights) {
  double sum = 0.0;
  double weight = 0.0;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    sum += weights[i] * AngleDifference(angles[i], angles.front());
    weight += weights[i];
  }
  return angles.front() + sum / weight;
}

/// Estimates the error of the heading at the end of a curve that is fitted to points [rad]. The
/// estimated heading error is the mean deviation of the points near the curve's end, divided by the
/// length of curve that they determine.
double HeadingError(const FittedPath& fit, bool at_begin) {
  // Error [rad] assumed for a heading from fewer than kManyPoints points, which do not determine
  // the curvature well.
  constexpr std::size_t kManyPoints = 4;
  constexpr double kFewPointsError = 0.1;   // [rad]
  constexpr double kSmallestError = 1e-12;  // [rad]
  if (fit.given.points.size() - fit.repeated - fit.merged < kManyPoints) {
    return kFewPointsError;
  }
  const double length = fit.path.length();
  const double near = std::min(length, std::max(fit.smoothing_length, 0.1 * length));
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < fit.stations.size(); ++i) {
    const double s = fit.stations[i];
    if (at_begin ? s <= near : s >= length - near) {
      sum += (fit.path.At(s).pose.position() - fit.given.points[i]).norm();
      count += 1.0;
    }
  }
  return sum / count / near + kSmallestError;
}

/// Returns the heading of the car at the cusp between two legs. The legs were fitted without
/// prescribed headings.
double CuspHeading(const PathPoints& given, const std::array<Leg, 2>& legs,
                   const std::array<const FittedPath*, 2>& fits) {
  // Heading difference above which the given headings are ignored [rad].
  constexpr double kFar = 0.3;
  std::vector<double> headings;
  std::vector<double> weights;
  std::vector<double> differences;
  for (std::size_t k = 0; k < 2; ++k) {
    const FittedPath& fit = *fits[k];
    const double travel = fit.path.At(k == 0 ? fit.path.length() : 0.0).pose.yaw;
    headings.push_back(CarHeading(travel, legs[k].direction));
    const double error = HeadingError(fit, k == 1);
    weights.push_back(1.0 / (error * error));
    for (std::size_t i = legs[k].first; !given.yaw.empty() && i <= legs[k].last; ++i) {
      const double own = fit.path.At(fit.stations[i - legs[k].first]).pose.yaw;
      differences.push_back(AngleDifference(CarHeading(own, legs[k].direction), given.yaw[i]));
    }
  }
  const double heading = MeanAngle(headings, weights);
  if (given.yaw.empty()) {
    return heading;
  }
  const double from_file = given.yaw[legs[1].first] +
                           MeanAngle(differences, std::vector<double>(differences.size(), 1.0));
  return std::abs(AngleDifference(from_file, heading)) < kFar ? from_file : heading;
}

/// Returns the headings of the car at the cusps between the legs, for legs that were fitted without
/// prescribed headings. At a cusp of a polyline, the car keeps the heading of the line before the
/// cusp.
std::vector<EndHeadings> HeadingsOfLegs(const PathPoints& given, const std::vector<Leg>& legs,
                                        const std::vector<FittedPath>& fits) {
  std::vector<EndHeadings> headings(legs.size());
  const bool is_polyline = fits.front().options.fit == PathFit::kPolyline;
  for (std::size_t i = 1; i < legs.size(); ++i) {
    const Path& before = fits[i - 1].path;
    const double heading =
        is_polyline ? CarHeading(before.At(before.length()).pose.yaw, legs[i - 1].direction)
                    : CuspHeading(given, {legs[i - 1], legs[i]}, {&fits[i - 1], &fits[i]});
    if (!is_polyline) {
      headings[i - 1].end = CarHeading(heading, legs[i - 1].direction);
    }
    headings[i].begin = CarHeading(heading, legs[i].direction);
  }
  return headings;
}

/// Fits a leg whose begin has exactly the heading of `wanted`, in the leg's direction of travel. A
/// spline that is sampled is turned a little, so that it ends at the last point. The next fit
/// compensates for this turn. JoinLegs would turn the whole leg otherwise, because it begins a leg
/// with the heading at the end of the leg before.
FittedPath FitFromHeading(const PathPoints& given, const PathFitOptions& options,
                          const EndHeadings& wanted, double max_curvature) {
  constexpr int kFits = 6;
  constexpr double kEqual = 1e-9;  // [rad]
  EndHeadings headings = wanted;
  FittedPath fit = FitLeg(given, options, headings, max_curvature);
  for (int i = 1; i < kFits && wanted.begin && options.fit == PathFit::kSpline; ++i) {
    const double error = AngleDifference(*wanted.begin, fit.path.At(0.0).pose.yaw);
    if (std::abs(error) <= kEqual) {
      break;
    }
    headings.begin = *headings.begin + error;
    fit = FitLeg(given, options, headings, max_curvature);
  }
  return fit;
}

/// Joins the fits of all legs to one path.
FittedPath JoinLegs(const std::vector<Leg>& legs, const std::vector<FittedPath>& fits) {
  FittedPath joined;
  std::vector<Segment> segments;
  double s = 0.0;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const FittedPath& fit = fits[i];
    for (HeadingJump jump : fit.jumps) {
      jump.point += legs[i].first;
      jump.s += s;
      jump.rounded = {jump.rounded.from + s, jump.rounded.to + s};
      joined.jumps.push_back(jump);
    }
    for (HeadingJump jump : fit.reversals) {
      jump.point += legs[i].first;
      jump.s += s;
      joined.reversals.push_back(jump);
    }
    for (std::size_t k = i == 0 ? 0 : 1; k < fit.stations.size(); ++k) {
      joined.stations.push_back(s + fit.stations[k]);
    }
    if (fit.bulge >= joined.bulge) {
      joined.bulge = fit.bulge;
      joined.bulge_station = s + fit.bulge_station;
    }
    joined.repeated += fit.repeated;
    joined.merged += fit.merged;
    joined.added += fit.added;
    joined.smoothing_length =
        i == 0 ? fit.smoothing_length : std::min(joined.smoothing_length, fit.smoothing_length);
    const std::vector<Segment> own = InDirection(fit.path.segments(), legs[i].direction);
    segments.insert(segments.end(), own.begin(), own.end());
    s += fit.path.length();
  }
  Pose2 start = fits.front().path.At(0.0).pose;
  start.yaw = CarHeading(start.yaw, legs.front().direction);
  joined.path = Path(start, std::move(segments));
  return joined;
}

}  // namespace

FittedPath FitOnce(PathPoints given, const PathFitOptions& options, double max_curvature,
                   std::optional<double> start_yaw) {
  given = AtStandstills(std::move(given), options.max_deviation);
  const std::vector<Leg> legs = FindLegs(given, options.max_deviation);
  EndHeadings start;
  if (start_yaw && !options.closed) {
    start.begin = CarHeading(*start_yaw, legs.front().direction);
  }
  FittedPath fitted;
  if (std::optional<FittedPath> followed = FollowGiven(given, legs, options)) {
    fitted = std::move(*followed);
  } else if (legs.size() == 1) {
    fitted = FitLeg(PointsOf(given, legs.front()), options, start, max_curvature);
    if (legs.front().direction < 0) {
      fitted = JoinLegs(legs, {std::move(fitted)});
    }
  } else {
    if (options.closed) {
      FailFit("closed", "a path with changes of direction cannot be closed; remove closed");
    }
    std::vector<FittedPath> fits;
    for (const Leg& leg : legs) {
      fits.push_back(FitLeg(PointsOf(given, leg), options, {}, max_curvature));
    }
    fitted = JoinLegs(legs, fits);
    if (fitted.reversals.empty()) {
      std::vector<EndHeadings> headings = HeadingsOfLegs(given, legs, fits);
      headings.front().begin = start.begin;
      for (std::size_t i = 0; i < legs.size(); ++i) {
        if (i > 0 && options.fit == PathFit::kSpline) {
          // The leg before may end with another heading than the prescribed one, by its noise.
          const Path& before = fits[i - 1].path;
          const double heading =
              CarHeading(before.At(before.length()).pose.yaw, legs[i - 1].direction);
          headings[i].begin = CarHeading(heading, legs[i].direction);
        }
        fits[i] = FitFromHeading(fits[i].given, options, headings[i], max_curvature);
      }
      fitted = JoinLegs(legs, fits);
    }
  }
  fitted.given = std::move(given);
  fitted.options = options;
  if (!fitted.reversals.empty()) {
    return fitted;
  }
  for (std::size_t point = 0; point < fitted.stations.size(); ++point) {
    fitted.stations[point] = std::min(fitted.stations[point], fitted.path.length());
    const Vec2 at = fitted.path.At(fitted.stations[point]).pose.position();
    const double deviation = (at - fitted.given.points[point]).norm();
    if (deviation > fitted.deviation) {
      fitted.deviation = deviation;
      fitted.deviation_point = point;
    }
  }
  fitted.heading_difference = HeadingDifference(fitted);
  return fitted;
}

}  // namespace trackbed
