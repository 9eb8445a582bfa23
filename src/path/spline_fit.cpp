#include "src/path/spline_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "src/path/bulge.h"
#include "src/path/least_variation.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/path/bezier.h"

// Fits a smooth path to points in two steps. First, a quintic smoothing spline over chord length is
// fitted (Reinsch 1967). Bisection finds the largest smoothing length at which the spline passes
// all points within the tolerance. Second, Newton's method finds the curve of least curvature
// variation with the spline's smoothing length, starting at the spline. If Newton's method does not
// converge, or the curve exceeds the tolerance, a shorter smoothing length is tried. The segments
// of the path describe the curve without further approximation.

namespace trackbed {
namespace {

/// Returns the largest distance of the points from the spline.
double Deviation(const SmoothingSpline& spline, const ChordPoints& points) {
  double deviation = 0.0;
  for (std::size_t i = 0; i < points.u.size(); ++i) {
    deviation = std::max(deviation, (spline.At(points.u[i]) - points.points[i]).norm());
  }
  return deviation;
}

/// Fraction of the largest deviation that the spline may use. The remaining 5 % are for the error
/// of the path segments that approximate the spline.
constexpr double kSplineShare = 0.95;

/// Rounds a positive length up to three significant digits.
double RoundUp(double length) {
  const double digit = std::pow(10.0, std::floor(std::log10(length)) - 2.0);
  return digit * std::ceil(length / digit);
}

/// Fits the spline with the largest smoothing length that keeps the spline within kSplineShare of
/// `max_deviation` [m] of all given and fitted points. FitWithin returns the smoothing length that
/// it found.
double FitWithin(SmoothingSpline& spline, const ChordPoints& given, const ChordPoints& fitted,
                 double max_deviation) {
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
    return deviation <= kSplineShare * max_deviation;
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
        FailFit("max_deviation",
                fmt::format("{:.3g} m cannot be kept: the nearest spline deviates by {:.3g} m; "
                            "use at least {:.3g} m",
                            max_deviation, smallest_deviation,
                            RoundUp(smallest_deviation / kSplineShare)));
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

/// Returns the station of a point with chord length u. If the point is a knot of the fitted path,
/// its station is that of the knot. A point that is no knot has the station of the nearest path
/// point between the adjacent knots.
double StationOf(const std::vector<double>& knot_stations, const std::vector<double>& knots,
                 const Path& path, double u, const Vec2& point) {
  const std::size_t i = LastBefore(knots, u);
  if (knots[i] == u) {
    return knot_stations[i];
  }
  const double to = knot_stations[std::min(i + 1, knots.size() - 1)];
  return path.Project({point.x(), point.y(), 0.0}, {knot_stations[i], to}).s;
}

/// A path fitted to knots, with their stations.
struct KnotPath {
  Path path;
  std::vector<double> stations;  // Station of each knot [m].
};

/// Returns curve nodes along the spline: each knot, and nodes between the knots such that the
/// spline turns by at most 1/8 rad between nodes. A node at a knot is exactly at the given point of
/// this knot.
std::vector<CurveNode> NodesAlong(const SmoothingSpline& spline, const ChordPoints& fitted,
                                  bool closed) {
  using Quadrature = boost::math::quadrature::gauss<double, 7>;
  constexpr double kNodeTurn = 0.125;  // Largest turn between nodes [rad].
  constexpr int kMeasured = 8;         // Number of parts in which an interval's turn is measured.
  const std::vector<double>& knots = spline.knots();
  const std::vector<double> weights = spline.weights();
  std::vector<CurveNode> nodes;
  const auto add = [&](double u) {
    const Vec2 tangent = spline.At(u, 1);
    const Vec2 at = spline.At(u);
    double yaw = std::atan2(tangent.y(), tangent.x());
    double length = 0.0;
    if (!nodes.empty()) {
      yaw = nodes.back().pose.yaw + AngleDifference(yaw, nodes.back().pose.yaw);
    }
    nodes.push_back({.pose = {at.x(), at.y(), yaw},
                     .curvature = CurvatureFromDerivatives(tangent, spline.At(u, 2)),
                     .length = length});
  };
  add(knots.front());
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    nodes.back().point = fitted.points[i];
    nodes.back().weight = weights[i];
    double turn = 0.0;
    Vec2 before = spline.At(knots[i], 1);
    for (int k = 1; k <= kMeasured; ++k) {
      const Vec2 own = spline.At(std::lerp(knots[i], knots[i + 1], k / double{kMeasured}), 1);
      turn += std::abs(std::atan2(Cross(before, own), before.dot(own)));
      before = own;
    }
    const double pieces = std::max(2.0, std::ceil(turn / kNodeTurn));
    double from = knots[i];
    for (double k = 1.0; k <= pieces; k += 1.0) {
      const double to = k == pieces ? knots[i + 1] : std::lerp(knots[i], knots[i + 1], k / pieces);
      add(to);
      nodes.back().length =
          Quadrature::integrate([&](double u) { return spline.At(u, 1).norm(); }, from, to);
      from = to;
    }
  }
  if (!closed) {
    nodes.back().point = fitted.points.back();
    nodes.back().weight = weights.back();
  }
  const std::size_t last = nodes.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const std::size_t before = i == 0 ? (closed ? last - 1 : 0) : i - 1;
    const std::size_t after = i == last ? (closed ? 1 : last) : i + 1;
    const double length = (i == before ? 0.0 : nodes[i == 0 ? last : i].length) +
                          (i == after ? 0.0 : nodes[after].length);
    nodes[i].sharpness = (nodes[after].curvature - nodes[before].curvature) / length;
  }
  return nodes;
}

/// Returns the path of a curve's nodes.
KnotPath PathThrough(const std::vector<CurveNode>& nodes, bool closed) {
  KnotPath found;
  double s = 0.0;
  for (const CurveNode& node : nodes) {
    s += &node == &nodes.front() ? 0.0 : node.length;
    if (node.point) {
      found.stations.push_back(s);
    }
  }
  found.path = Path(nodes.front().pose, SegmentsBetween(nodes));
  found.stations.back() = closed ? found.stations.back() : found.path.length();
  if (closed) {
    found.stations.push_back(found.path.length());
  }
  return found;
}

/// Returns points relative to `origin`.
ChordPoints Relative(ChordPoints points, const Vec2& origin) {
  for (Vec2& point : points.points) {
    point -= origin;
  }
  return points;
}

/// Points to which a spline is fitted, relative to the first knot, so that large coordinates cause
/// no rounding errors.
struct LocalPoints {
  ChordPoints knots;
  ChordPoints distinct;
  ChordPoints given;
  double period = 0.0;
  EndHeadings headings;  // Prescribed headings at the ends of the spline.
  double max_curvature = kUnbounded;
};

/// Returns the station of each distinct point on a path.
std::vector<double> DistinctStations(const KnotPath& found, const LocalPoints& local) {
  std::vector<double> stations;
  for (std::size_t i = 0; i < local.distinct.u.size(); ++i) {
    stations.push_back(StationOf(found.stations, local.knots.u, found.path, local.distinct.u[i],
                                 local.distinct.points[i]));
  }
  return stations;
}

/// Returns whether a path keeps within the tolerance of all given points and knots.
bool IsWithin(const KnotPath& found, const LocalPoints& local, double tolerance) {
  const auto apart = [&](double s, const Vec2& point) {
    return (found.path.At(s).pose.position() - point).norm();
  };
  for (std::size_t i = 0; i < local.knots.points.size(); ++i) {
    if (apart(found.stations[i], local.knots.points[i]) > tolerance) {
      return false;
    }
  }
  const std::vector<double> stations = DistinctStations(found, local);
  for (std::size_t i = 0; i < local.given.points.size(); ++i) {
    const std::size_t own = LastBefore(local.distinct.u, local.given.u[i]);
    const double s = local.given.u[i] > local.distinct.u[own] ? found.path.length() : stations[own];
    if (apart(s, local.given.points[i]) > tolerance) {
      return false;
    }
  }
  return true;
}

Bulge BulgeOf(const KnotPath& found, const LocalPoints& local, double tolerance) {
  const auto curve = [&](std::size_t knot, double share) -> Vec2 {
    return found.path.At(std::lerp(found.stations[knot], found.stations[knot + 1], share))
        .pose.position();
  };
  return FindBulge(curve, local.knots, local.period, tolerance);
}

/// Moves, turns and scales a path slightly, so that it begins and ends at the first and last of
/// `points`.
KnotPath BetweenEnds(KnotPath found, const std::vector<Vec2>& points) {
  const Pose2 begin = found.path.At(0.0).pose;
  const Vec2 own = found.path.At(found.path.length()).pose.position() - begin.position();
  const Vec2 wanted = points.back() - points.front();
  if (own.norm() == 0.0 || wanted.norm() == 0.0) {
    return found;
  }
  const double scale = wanted.norm() / own.norm();
  const double turn = std::atan2(Cross(own, wanted), own.dot(wanted));
  std::vector<Segment> segments = found.path.segments();
  for (Segment& segment : segments) {
    segment.length *= scale;
    segment.curvature /= scale;
    segment.sharpness /= scale * scale;
    segment.sharpness_rate /= scale * scale * scale;
  }
  for (double& station : found.stations) {
    station *= scale;
  }
  found.path =
      Path({points.front().x(), points.front().y(), begin.yaw + turn}, std::move(segments));
  found.stations.back() = found.path.length();
  return found;
}

/// Returns the largest allowed length of a path segment [m]: 0.1 m or a millionth of the path,
/// whichever is longer.
double SpacingOf(const SmoothingSpline& spline) {
  constexpr double kUsualLength = 0.1;
  constexpr double kUsualSegments = 1e6;
  return std::max(kUsualLength, spline.knots().back() / kUsualSegments);
}

/// Divides segments into equal parts of at most `spacing` [m], which does not change the path.
std::vector<Segment> Divided(const std::vector<Segment>& segments, double spacing) {
  std::vector<Segment> parts;
  for (const Segment& segment : segments) {
    const double count = std::max(1.0, std::ceil(segment.length / spacing - 1e-9));
    const double length = segment.length / count;
    for (double i = 0.0; i < count; i += 1.0) {
      const double d = i * length;
      parts.push_back({length, segment.CurvatureAt(d), segment.direction,
                       segment.sharpness + d * segment.sharpness_rate, segment.sharpness_rate});
    }
  }
  return parts;
}

/// Returns a path of segments through samples of the spline, which are dense enough to keep the
/// tolerance.
KnotPath PathAlong(const SmoothingSpline& spline, const LocalPoints& local, double tolerance) {
  constexpr int kMaxHalvings = 6;
  constexpr std::size_t kMaxSegments = 4'000'000;
  const Vec2 start = spline.At(spline.knots().front());
  double spacing = SpacingOf(spline);
  for (int halvings = 0; halvings <= kMaxHalvings; ++halvings, spacing *= 0.5) {
    const SampledSpline sampled = Sample(spline, spacing, kMaxSegments);
    if (sampled.is_too_long) {
      break;
    }
    if (sampled.points.empty()) {
      FailFit("max_deviation", "the spline has a cusp; allow a larger deviation");
    }
    KnotPath found{
        Path({start.x(), start.y(), sampled.points.front().yaw}, SegmentsThrough(sampled.points)),
        sampled.knot_stations};
    found = local.period > 0.0 ? found : BetweenEnds(found, local.knots.points);
    if (IsWithin(found, local, tolerance)) {
      return found;
    }
  }
  FailFit("max_deviation",
          fmt::format("{:.3g} m cannot be kept by the path's segments", tolerance));
}

/// Fits the curve of least variation near the spline, and sets its smoothing length. Returns
/// nullopt if no curve converges within the tolerance. FitCurve may change the smoothing length of
/// `spline`.
std::optional<KnotPath> FitCurve(SmoothingSpline& spline, const LocalPoints& local,
                                 double& smoothing_length, double tolerance) {
  // FitCurve tries up to kLengths smoothing lengths, each kShorter times the previous length.
  // Newton's method starts from a spline whose smoothing length is an element of kStarts times the
  // curve's.
  constexpr int kLengths = 16;
  constexpr int kMaxFailures =
      2;  // Number of smoothing lengths without convergence after which the search ends.
  constexpr double kShorter = 0.8;
  constexpr std::array<double, 2> kStarts{1.0, 2.0};
  const bool closed = local.period > 0.0;
  double own_length = smoothing_length;
  std::optional<std::vector<CurveNode>> nodes;
  int failures = 0;
  for (int i = 0; i < kLengths && failures < kMaxFailures; ++i, own_length *= kShorter) {
    if (nodes) {
      nodes = LeastVariationCurve(*nodes, own_length, closed, local.headings, local.max_curvature);
    }
    for (std::size_t k = 0; k < (i == 0 ? kStarts.size() : 1) && !nodes; ++k) {
      if (spline.Fit(kStarts[k] * own_length)) {
        nodes = LeastVariationCurve(NodesAlong(spline, local.knots, closed), own_length, closed,
                                    local.headings, local.max_curvature);
      }
    }
    if (!nodes) {
      ++failures;
      continue;
    }
    KnotPath found = PathThrough(*nodes, closed);
    if (IsWithin(found, local, tolerance) && !BulgeOf(found, local, tolerance).IsAside(tolerance)) {
      smoothing_length = own_length;
      return found;
    }
  }
  return std::nullopt;
}

/// The smoothing spline with the largest smoothing length at which the spline stays within the
/// tolerance.
struct SplineFit {
  LocalPoints local;
  std::unique_ptr<SmoothingSpline> spline;
  double smoothing_length = 0.0;

  [[nodiscard]] Vec2 At(std::size_t knot, double share) const {
    return spline->At(std::lerp(spline->knots()[knot], spline->knots()[knot + 1], share));
  }
};

SplineFit FitSplineOnly(const ChordPoints& knots, const DistinctPoints& distinct,
                        const EndHeadings& headings, double max_curvature,
                        const FittedPath& fitted) {
  const Vec2 origin = knots.points.front();
  LocalPoints local{Relative(knots, origin),
                    Relative(distinct.chords, origin),
                    Relative({distinct.given_u, fitted.given.points}, origin),
                    distinct.period,
                    headings,
                    max_curvature};
  auto spline = std::make_unique<SmoothingSpline>(local.knots, local.period, headings);
  const double smoothing_length =
      FitWithin(*spline, local.given, local.knots, fitted.options.max_deviation);
  return {std::move(local), std::move(spline), smoothing_length};
}

}  // namespace

void FitSpline(const ChordPoints& knots, const DistinctPoints& distinct,
               const EndHeadings& headings, double max_curvature, FittedPath& fitted,
               std::vector<double>& stations) {
  constexpr int kMaxFills = 3;
  const double tolerance = fitted.options.max_deviation;
  const Vec2 origin = knots.points.front();
  SplineFit fit = FitSplineOnly(knots, distinct, headings, max_curvature, fitted);
  const auto curve = [&](std::size_t knot, double share) -> Vec2 { return fit.At(knot, share); };
  ChordPoints filled = knots;
  for (int i = 0; i < kMaxFills; ++i) {
    const std::vector<std::size_t> straight =
        StraightSteps(curve, fit.local.knots, distinct.period, tolerance);
    if (straight.empty()) {
      break;
    }
    filled = WithPointsOn(filled, distinct.period, straight);
    fit = FitSplineOnly(filled, distinct, headings, max_curvature, fitted);
  }
  fitted.added = filled.points.size() - knots.points.size();
  const Bulge swing = FindBulge(curve, fit.local.knots, distinct.period, tolerance);
  if (swing.IsAside(tolerance)) {
    RefuseBulge(swing, filled, distinct, fitted.given, tolerance);
  }
  const LocalPoints& local = fit.local;
  SmoothingSpline& spline = *fit.spline;
  double smoothing_length = fit.smoothing_length;
  std::optional<KnotPath> curve_path = FitCurve(spline, local, smoothing_length, tolerance);
  if (!curve_path) {
    TRACKBED_CHECK(spline.Fit(smoothing_length), "a smoothing length of {} m", smoothing_length);
    curve_path = PathAlong(spline, local, tolerance);
  }
  const KnotPath& found = *curve_path;
  const Bulge bulge = BulgeOf(found, local, tolerance);
  fitted.smoothing_length = smoothing_length;
  fitted.bulge = bulge.distance;
  fitted.bulge_station = found.stations[bulge.knot];
  const Pose2 start = found.path.At(0.0).pose;
  fitted.path = Path({origin.x() + start.x, origin.y() + start.y, start.yaw},
                     Divided(found.path.segments(), SpacingOf(spline)));
  stations = DistinctStations(found, local);
  for (double& station : stations) {
    station = std::min(station, fitted.path.length());
  }
  if (local.period == 0.0) {
    stations.back() = fitted.path.length();
  }
}

}  // namespace trackbed
