#include "trackbed/path/fit_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/path/smoothing_spline.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

// Fits a path to points. FitPath drops repeated points, and optionally resamples the other points
// along straight lines. A spline fit computes a quintic smoothing spline over chord length (Reinsch
// 1967). Bisection finds the largest smoothing length at which the spline passes all points within
// the tolerance. Samples of the spline are then joined by path segments; their spacing is reduced
// until the segments are within the tolerance, too. A polyline fit joins straight lines by arcs
// with tangents of at most 1 mm. Points at which the path turns back are reported as reversals.

namespace trackbed {
namespace {

constexpr std::size_t kMaxFittedPoints = 200'000;
// Distance below which two successive points count as a repeated point [m].
constexpr double kEqualityTolerance = 1e-9;

[[noreturn]] void Fail(const std::string& key, std::string message, int line = 0) {
  throw InputError(Problem{.line = line, .key = key, .message = std::move(message)});
}

/// Returns the number of the line that defines a point in the input file; 0 if the line number is
/// unknown.
int LineOf(const PathPoints& given, std::size_t point) {
  return given.lines.empty() ? 0 : given.lines[point];
}

/// Describes a point for error messages, such as "row 7 at (1, 2)", or "point 6 at (1, 2)" if line
/// numbers are not known.
std::string NameOf(const PathPoints& given, std::size_t point) {
  const Vec2& at = given.points[point];
  const int line = LineOf(given, point);
  return fmt::format("{} {} at ({:.6g}, {:.6g})", line > 0 ? "row" : "point",
                     line > 0 ? static_cast<std::size_t>(line) : point + 1, at.x(), at.y());
}

/// The given points without repeated points, with the chord length at each point.
struct DistinctPoints {
  ChordPoints chords;
  std::vector<std::size_t> number;  // Index of each distinct point among the given points.
  std::vector<double> given_u;      // Chord length along the polyline up to each given point.
  double period = 0.0;              // Period of a closed path [m]; 0 for an open path.
};

DistinctPoints Distinct(const PathPoints& given, bool closed) {
  DistinctPoints distinct;
  ChordPoints& chords = distinct.chords;
  for (std::size_t i = 0; i < given.points.size(); ++i) {
    const Vec2& point = given.points[i];
    const double step = chords.points.empty() ? 0.0 : (point - chords.points.back()).norm();
    if (chords.points.empty() || step > kEqualityTolerance) {
      chords.u.push_back(chords.u.empty() ? 0.0 : chords.u.back() + step);
      chords.points.push_back(point);
      distinct.number.push_back(i);
    }
    distinct.given_u.push_back(chords.u.back());
  }
  if (closed && chords.points.size() > 2) {
    double gap = (chords.points.front() - chords.points.back()).norm();
    if (gap <= kEqualityTolerance) {
      chords.points.pop_back();
      gap = chords.u.back() - *(chords.u.end() - 2);
      chords.u.pop_back();
      distinct.number.pop_back();
    }
    distinct.period = chords.u.back() + gap;
  }
  return distinct;
}

/// Returns the index of the last element that is at most u, for u >= 0 and an ascending list that
/// begins with 0.
std::size_t LastBefore(const std::vector<double>& rising, double u) {
  const auto after = std::upper_bound(rising.begin(), rising.end(), u);
  return static_cast<std::size_t>(after - rising.begin()) - 1;
}

/// Returns the point on the polyline at chord length u.
Vec2 OnLines(const ChordPoints& chords, double u) {
  const std::size_t i = LastBefore(chords.u, u);
  if (i + 1 == chords.u.size()) {
    return chords.points.back();
  }
  const double share = (u - chords.u[i]) / (chords.u[i + 1] - chords.u[i]);
  return chords.points[i] + share * (chords.points[i + 1] - chords.points[i]);
}

void CheckLength(const DistinctPoints& distinct, const PathPoints& given) {
  const std::vector<double>& u = distinct.chords.u;
  const double length = std::max(u.back(), distinct.period);
  if (length <= kMaxPathLength) {
    return;
  }
  std::size_t widest = 1;
  for (std::size_t i = 2; i < u.size(); ++i) {
    widest = u[i] - u[i - 1] > u[widest] - u[widest - 1] ? i : widest;
  }
  const std::size_t before = distinct.number[widest - 1];
  const std::size_t after = distinct.number[widest];
  const bool has_lines = !given.lines.empty();
  const double gap = u[widest] - u[widest - 1];
  const bool is_cause = length - gap <= kMaxPathLength;
  Fail("",
       fmt::format(
           "the path is {:.7g} m long; must be at most {:.7g} m: the {} between {} {} and {} "
           "is {:.7g} m; {}",
           length, kMaxPathLength, is_cause ? "gap" : "largest gap", has_lines ? "rows" : "points",
           has_lines ? LineOf(given, before) : static_cast<int>(before) + 1,
           has_lines ? LineOf(given, after) : static_cast<int>(after) + 1, gap,
           is_cause ? "correct the point or the unit of the positions, or divide the path"
                    : "divide the path, or correct the unit of the positions"),
       is_cause ? LineOf(given, after) : 0);
}

ChordPoints Resampled(const DistinctPoints& distinct, double spacing) {
  ChordPoints lines = distinct.chords;
  if (distinct.period > 0.0) {
    lines.u.push_back(distinct.period);
    lines.points.push_back(lines.points.front());
  }
  const double length = lines.u.back();
  const double count = std::max(1.0, std::ceil(length / spacing));
  if (count > static_cast<double>(kMaxFittedPoints)) {
    Fail("resample", fmt::format("{:.4g} m every {:.4g} m are more than {} points", length, spacing,
                                 kMaxFittedPoints));
  }
  ChordPoints resampled;
  const double last = distinct.period > 0.0 ? count - 1.0 : count;
  for (double i = 0.0; i <= last; i += 1.0) {
    resampled.u.push_back(length * i / count);
    resampled.points.push_back(OnLines(lines, resampled.u.back()));
  }
  return resampled;
}

/// Calls `call` with the change of direction at each inner point of the polyline. On a closed path,
/// every point is an inner point.
template <typename Call>
void ForEachTurn(const ChordPoints& chords, double period, const Call& call) {
  const std::size_t count = chords.points.size();
  const std::size_t begin = period > 0.0 ? 0 : 1;
  const std::size_t end = period > 0.0 ? count : count - 1;
  for (std::size_t i = begin; i < end; ++i) {
    const Vec2 in = chords.points[i] - chords.points[(i + count - 1) % count];
    const Vec2 out = chords.points[(i + 1) % count] - chords.points[i];
    call(i, std::atan2(Cross(in, out), in.dot(out)), std::min(in.norm(), out.norm()));
  }
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

/// Returns the largest distance of the points from the spline.
double Deviation(const SmoothingSpline& spline, const ChordPoints& points) {
  double deviation = 0.0;
  for (std::size_t i = 0; i < points.u.size(); ++i) {
    deviation = std::max(deviation, (spline.At(points.u[i]) - points.points[i]).norm());
  }
  return deviation;
}

/// Fits the spline with the largest smoothing length that keeps the spline within `tolerance` [m]
/// of all given and fitted points. Returns the smoothing length found.
double FitWithin(SmoothingSpline& spline, const ChordPoints& given, const ChordPoints& fitted,
                 double tolerance) {
  const std::vector<double>& knots = spline.knots();
  const double length = knots.back() - knots.front();
  double least = length;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    least = std::min(least, knots[i] - knots[i - 1]);
  }
  double smallest_deviation = std::numeric_limits<double>::infinity();
  const auto fits = [&](double smoothing) {
    if (!spline.Fit(smoothing)) {
      return false;
    }
    const double deviation = std::max(Deviation(spline, given), Deviation(spline, fitted));
    smallest_deviation = std::min(smallest_deviation, deviation);
    return deviation <= tolerance;
  };
  double good = length / static_cast<double>(knots.size() - 1);
  double bad = good;
  if (fits(good)) {
    do {
      bad = 2.0 * good;
    } while (fits(bad) && (good = bad) < length);
    if (good >= length) {
      return good;
    }
  } else {
    do {
      good *= 0.5;
      if (good < 1e-3 * least) {
        Fail("max_deviation", fmt::format("{:.3g} m cannot be kept: the nearest spline deviates by "
                                          "{:.3g} m",
                                          tolerance, smallest_deviation));
      }
    } while (!fits(good));
    bad = 2.0 * good;
  }
  while (bad / good > 1.1) {
    const double middle = std::sqrt(good * bad);
    (fits(middle) ? good : bad) = middle;
  }
  TRACKBED_CHECK(fits(good), "a smoothing length of {} m fits no more", good);
  return good;
}

/// Deviation of a spline from the straight line between two adjacent knots.
struct Bulge {
  // Largest distance of the spline from the straight line between the knots [m].
  double distance = 0.0;
  // Largest distance from the straight line that is plausible for a smooth path through the points
  // [m].
  double plausible = 0.0;
  double length = 0.0;   // Length of the spline between the knots [m].
  double chord = 0.0;    // Length of the straight line between the knots [m].
  std::size_t knot = 0;  // Index of the knot at which the stretch begins.

  /// Returns whether the spline deviates from the line by more than a plausible distance. The check
  /// takes into account that the spline may pass both ends of the line at a distance of up to the
  /// tolerance.
  [[nodiscard]] bool IsAside(double tolerance) const {
    return distance > plausible + tolerance || length > 0.5 * kPi * chord + 2.0 * tolerance;
  }
};

double DistanceToLine(const Vec2& p, const Vec2& from, const Vec2& to) {
  const Vec2 line = to - from;
  const double share = std::clamp(line.dot(p - from) / line.squaredNorm(), 0.0, 1.0);
  return (from + share * line - p).norm();
}

/// Returns the largest plausible distance of a smooth path from a chord between two points. On a
/// circle through three neighboring points, the angle between the two chords is half of the sum of
/// the two arcs' angles. Hence, if adjacent chords turn by phi, the arc over a chord has an angle
/// of at most 2 phi. An arc of the angle 2 phi rises chord/2 tan(phi/2) above its chord. Splines
/// also deviate by up to a fifth of the chord near more distant corners.
double PlausibleBulge(double chord, double turn) {
  constexpr double kSwing = 0.2;
  return chord * std::max(kSwing, 0.5 * std::tan(0.5 * std::min(turn, 0.5 * kPi)));
}

/// Measures the deviation of the spline from the straight line after a knot. Between knots, the
/// spline is a polynomial of degree 5, so sixteen points suffice to measure the distance.
Bulge BulgeAfter(const SmoothingSpline& spline, std::size_t knot, const Vec2& from, const Vec2& to,
                 double turn) {
  constexpr int kPieces = 16;
  const std::vector<double>& knots = spline.knots();
  Bulge bulge{.chord = (to - from).norm(), .knot = knot};
  bulge.plausible = PlausibleBulge(bulge.chord, turn);
  Vec2 at = spline.At(knots[knot]);
  for (int k = 1; k <= kPieces; ++k) {
    const Vec2 next = spline.At(std::lerp(knots[knot], knots[knot + 1], k / double{kPieces}));
    bulge.length += (next - at).norm();
    at = next;
    bulge.distance = std::max(bulge.distance, DistanceToLine(at, from, to));
  }
  return bulge;
}

/// Returns the first stretch between two knots on which the spline deviates too far from the
/// straight line (IsAside). If the spline deviates too far on no stretch, returns the stretch with
/// the largest distance.
Bulge FindBulge(const SmoothingSpline& spline, const ChordPoints& fitted, double period,
                double tolerance) {
  const std::size_t count = fitted.points.size();
  std::vector<double> turns(count, 0.0);
  ForEachTurn(fitted, period,
              [&](std::size_t i, double angle, double /*shorter*/) { turns[i] = std::abs(angle); });
  Bulge largest;
  for (std::size_t i = 0; i + 1 < spline.knots().size(); ++i) {
    const std::size_t next = (i + 1) % count;
    const Bulge own = BulgeAfter(spline, i, fitted.points[i], fitted.points[next],
                                 std::max(turns[i], turns[next]));
    if (own.IsAside(tolerance)) {
      return own;
    }
    largest = own.distance > largest.distance ? own : largest;
  }
  return largest;
}

/// Returns the length by which the polyline shrinks if a point is removed [m].
double DetourOf(const std::vector<Vec2>& points, std::size_t i) {
  const double before = i > 0 ? (points[i] - points[i - 1]).norm() : 0.0;
  const double after = i + 1 < points.size() ? (points[i + 1] - points[i]).norm() : 0.0;
  return i > 0 && i + 1 < points.size() ? before + after - (points[i + 1] - points[i - 1]).norm()
                                        : before + after;
}

[[noreturn]] void RefuseBulge(const Bulge& bulge, const ChordPoints& fitted,
                              const DistinctPoints& distinct, const PathPoints& given) {
  const std::vector<Vec2>& points = distinct.chords.points;
  const std::size_t before = LastBefore(distinct.chords.u, fitted.u[bulge.knot]);
  const std::size_t after = (before + 1) % points.size();
  // Find the input point that is probably wrong. Of the two points at the ends of the stretch on
  // which the spline deviates, choose the point whose removal shortens the polyline more.
  std::size_t wrong = before;
  for (const std::size_t i : {before, after}) {
    wrong = DetourOf(points, i) > DetourOf(points, wrong) ? i : wrong;
  }
  const std::size_t number = distinct.number[wrong];
  Fail("",
       fmt::format(
           "the spline swings up to {:.4g} m aside of the straight line of {:.4g} m from {} "
           "to {}; must be at most {:.4g} m with these turns. Is {} wrong? Else resample the "
           "points, which keeps to the straight lines, or use fit: polyline",
           bulge.distance, bulge.chord, NameOf(given, distinct.number[before]),
           NameOf(given, distinct.number[after]), bulge.plausible, NameOf(given, number)),
       LineOf(given, number));
}

/// Returns the station of a point with chord length u. If the point is a knot of the fitted path,
/// its station is that of the knot. Any other point has the station of the nearest path point
/// between the adjacent knots.
double StationOf(const SampledSpline& sampled, const std::vector<double>& knots, const Path& path,
                 double u, const Vec2& point) {
  const std::size_t i = LastBefore(knots, u);
  if (knots[i] == u) {
    return sampled.knot_stations[i];
  }
  const double to = sampled.knot_stations[std::min(i + 1, knots.size() - 1)];
  return path.Project({point.x(), point.y(), 0.0}, {sampled.knot_stations[i], to}).s;
}

/// Returns the largest distance between a given point and the path at the point's station, and the
/// index of that point.
std::pair<double, std::size_t> LargestDeviation(const Path& path, const ChordPoints& chords,
                                                const std::vector<double>& stations) {
  std::pair<double, std::size_t> largest{0.0, 0};
  for (std::size_t i = 0; i < chords.points.size(); ++i) {
    const double own = (path.At(stations[i]).pose.position() - chords.points[i]).norm();
    largest = std::max(largest, {own, i}, [](auto& a, auto& b) { return a.first < b.first; });
  }
  return largest;
}

void FitSpline(const ChordPoints& knots, const DistinctPoints& distinct, FittedPath& fitted,
               std::vector<double>& stations) {
  // Sample spacing at which the refinement starts [m]; on a path longer than 100 km, the spacing is
  // larger.
  constexpr double kSpacing = 0.1;
  constexpr int kMaxHalvings = 6;
  constexpr double kUsualSegments = 1e6;  // Number of segments of a path longer than 100 km.
  constexpr std::size_t kMaxSegments = 4'000'000;
  const double tolerance = fitted.options.max_deviation;
  SmoothingSpline spline(knots, distinct.period);
  // Reserve 5 % of the tolerance for the error of the path segments, which approximate the spline.
  fitted.smoothing_length = FitWithin(spline, distinct.chords, knots, 0.95 * tolerance);
  const Bulge bulge = FindBulge(spline, knots, distinct.period, tolerance);
  if (bulge.IsAside(tolerance)) {
    RefuseBulge(bulge, knots, distinct, fitted.given);
  }
  fitted.bulge = bulge.distance;
  const Vec2 start = spline.At(spline.knots().front());
  double spacing = std::max(kSpacing, spline.knots().back() / kUsualSegments);
  for (int halvings = 0; halvings <= kMaxHalvings; ++halvings, spacing *= 0.5) {
    const SampledSpline sampled = Sample(spline, spacing, kMaxSegments);
    if (sampled.is_too_long) {
      break;
    }
    if (sampled.points.empty()) {
      Fail("max_deviation", "the spline has a cusp; allow a larger deviation");
    }
    fitted.path =
        Path({start.x(), start.y(), sampled.points.front().yaw}, SegmentsThrough(sampled.points));
    fitted.bulge_station = sampled.knot_stations[bulge.knot];
    stations.clear();
    for (std::size_t i = 0; i < distinct.chords.u.size(); ++i) {
      stations.push_back(StationOf(sampled, spline.knots(), fitted.path, distinct.chords.u[i],
                                   distinct.chords.points[i]));
    }
    if (LargestDeviation(fitted.path, distinct.chords, stations).first <= tolerance &&
        LargestDeviation(fitted.path, knots, sampled.knot_stations).first <= tolerance) {
      return;
    }
  }
  Fail("max_deviation", fmt::format("{:.3g} m cannot be kept by the path's segments", tolerance));
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
      Fail("",
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
  const ChordPoints chords = Distinct(given, false).chords;
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
  const DistinctPoints distinct = Distinct(given, options.closed);
  FittedPath fitted;
  fitted.given = std::move(given);
  fitted.options = options;
  const std::size_t count = distinct.chords.points.size();
  if (count < 2 || (options.closed && count < 3)) {
    Fail("", fmt::format("{} different point{}; must be at least {}", count, count == 1 ? "" : "s",
                         options.closed ? 3 : 2));
  }
  CheckLength(distinct, fitted.given);
  fitted.repeated = fitted.given.points.size() - count;
  const ChordPoints own =
      options.resample ? Resampled(distinct, *options.resample) : distinct.chords;
  if (own.points.size() > kMaxFittedPoints) {
    Fail("resample", fmt::format("{} points; must be at most {}, give a distance to resample them",
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
  const auto [deviation, where] = LargestDeviation(fitted.path, distinct.chords, stations);
  fitted.deviation = deviation;
  fitted.deviation_point = distinct.number[where];
  // A repeated point gets the station of its predecessor. The last point of a closed path gets the
  // station of the path's end.
  for (const double u : distinct.given_u) {
    const std::size_t i = LastBefore(distinct.chords.u, u);
    fitted.stations.push_back(u > distinct.chords.u[i] ? fitted.path.length() : stations[i]);
  }
  fitted.heading_difference = HeadingDifference(fitted);
  return fitted;
}

}  // namespace trackbed
