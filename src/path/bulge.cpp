#include "src/path/bulge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

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

/// Measures the deviation of a curve from the straight line after a knot. `curve` returns the
/// curve's point for a share of the way from 0 to 1. Golden-section search refines the largest of
/// sixteen distances.
template <typename Curve>
Bulge BulgeAfter(const Curve& curve, std::size_t knot, const Vec2& from, const Vec2& to,
                 double turn) {
  constexpr int kPieces = 16;
  constexpr int kRefinements = 10;
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  Bulge bulge{.chord = (to - from).norm(), .knot = knot};
  bulge.plausible = PlausibleBulge(bulge.chord, turn);
  double farthest = 0.0;
  const auto measure = [&](double share) -> Vec2 {
    const Vec2 at = curve(share);
    const double distance = DistanceToLine(at, from, to);
    if (distance > bulge.distance) {
      bulge.distance = distance;
      farthest = share;
    }
    return at;
  };
  Vec2 at = curve(0.0);
  for (int k = 1; k <= kPieces; ++k) {
    const Vec2 next = measure(k / double{kPieces});
    bulge.length += (next - at).norm();
    at = next;
  }
  double step = golden / kPieces;
  for (int k = 0; k < kRefinements; ++k, step *= golden) {
    const double middle = farthest;
    measure(std::max(0.0, middle - step));
    measure(std::min(1.0, middle + step));
  }
  return bulge;
}

/// Returns the length by which the polyline shrinks if a point is removed [m].
double DetourOf(const std::vector<Vec2>& points, std::size_t i) {
  const double before = i > 0 ? (points[i] - points[i - 1]).norm() : 0.0;
  const double after = i + 1 < points.size() ? (points[i + 1] - points[i]).norm() : 0.0;
  return i > 0 && i + 1 < points.size() ? before + after - (points[i + 1] - points[i - 1]).norm()
                                        : before + after;
}

}  // namespace

Bulge FindBulge(const CurveBetweenKnots& curve, const ChordPoints& fitted, double period,
                double tolerance) {
  const std::size_t count = fitted.points.size();
  std::vector<double> turns(count, 0.0);
  ForEachTurn(fitted, period,
              [&](std::size_t i, double angle, double /*shorter*/) { turns[i] = std::abs(angle); });
  Bulge largest;
  for (std::size_t i = 0; i + 1 < count + (period > 0.0 ? 1 : 0); ++i) {
    const std::size_t next = (i + 1) % count;
    const Bulge own =
        BulgeAfter([&](double share) -> Vec2 { return curve(i, share); }, i, fitted.points[i],
                   fitted.points[next], std::max(turns[i], turns[next]));
    if (own.IsAside(tolerance)) {
      return own;
    }
    largest = own.distance > largest.distance ? own : largest;
  }
  return largest;
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
  FailFit("",
          fmt::format(
              "the spline swings up to {:.4g} m aside of the straight line of {:.4g} m from {} "
              "to {}; must be at most {:.4g} m with these turns. Is {} wrong? Else resample the "
              "points, which keeps to the straight lines, or use fit: polyline",
              bulge.distance, bulge.chord, NameOf(given, distinct.number[before]),
              NameOf(given, distinct.number[after]), bulge.plausible, NameOf(given, number)),
          LineOf(given, number));
}

}  // namespace trackbed
