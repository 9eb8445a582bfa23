#include "src/path/bulge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

// Finds where a fitted spline swings aside of the straight line between two points.
// 1. FindBulge measures the largest distance between the curve and each chord, and compares the
//    distance with the plausible one: a circle through neighboring points leaves its chord by no
//    more.
// 2. StraightSteps finds the steps on which the points leave out a straight, and WithPointsOn adds
//    points to these steps.
// 3. RefuseBulge names the input point that is probably wrong, and the remedies.

namespace trackbed {
namespace {

double DistanceToLine(const Vec2& p, const Vec2& from, const Vec2& to) {
  const Vec2 line = to - from;
  const double share = std::clamp(line.dot(p - from) / line.squaredNorm(), 0.0, 1.0);
  return (from + share * line - p).norm();
}

/// Returns the largest plausible distance of a smooth path from a chord between two points. On a
/// circle through three neighboring points, the angle between the two chords is half of the sum of
/// the two arcs' angles. If adjacent chords of a polyline turn by phi, the arc over a chord has an
/// angle of at most 2 phi. An arc of the angle 2 phi rises by chord/2 tan(phi/2) above its chord.
/// Near more distant corners, splines also deviate from the chord by up to a fifth of its length.
double PlausibleBulge(double chord, double turn) {
  constexpr double kSwing = 0.2;
  return chord * std::max(kSwing, 0.5 * std::tan(0.5 * std::min(turn, 0.5 * kPi)));
}

/// Measures the deviation of a curve from the straight line after a knot. `curve` returns the
/// curve's point for a fraction of the step, from 0 to 1. Golden-section search refines the largest
/// of sixteen sampled distances.
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

/// Returns the absolute change of the polyline's direction at each point [rad]; 0 at the ends of an
/// open path.
std::vector<double> TurnsOf(const ChordPoints& fitted, double period) {
  std::vector<double> turns(fitted.points.size(), 0.0);
  ForEachTurn(fitted, period,
              [&](std::size_t i, double angle, double /*shorter*/) { turns[i] = std::abs(angle); });
  return turns;
}

/// Returns the distance from each point to the next point.
std::vector<double> StepsOf(const ChordPoints& fitted, double period) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < fitted.u.size(); ++i) {
    steps.push_back(fitted.u[i] - fitted.u[i - 1]);
  }
  if (period > 0.0) {
    steps.push_back(period - fitted.u.back());
  }
  return steps;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Returns whether the polyline's curvature on a step is less than a quarter of the curvature
/// beside it, as on a straight without points. On a long step on an arc, the curvature equals the
/// curvature beside the step. At the beginning of an arc, the curvature on a step is half of the
/// curvature beside the step.
bool IsStraighter(const std::vector<double>& turns, const std::vector<double>& lengths,
                  std::size_t step, double period) {
  const std::size_t count = lengths.size();
  const bool closed = period > 0.0;
  const auto length = [&](std::size_t i) { return lengths[i % count]; };
  const auto turn = [&](std::size_t i) { return turns[i % turns.size()]; };
  double curvature = 0.0;
  double beside = 0.0;
  if (closed || step > 0) {
    beside += 0.5 * length(step + count - 1);
  }
  if (closed || step + 1 < count) {
    beside += 0.5 * length(step + 1);
  }
  if (closed || step > 1) {
    const double pair = length(step + count - 2) + length(step + count - 1);
    curvature = std::max(curvature, 2.0 * turn(step + turns.size() - 1) / pair);
  }
  if (closed || step + 2 < count) {
    curvature = std::max(curvature, 2.0 * turn(step + 2) / (length(step + 1) + length(step + 2)));
  }
  return turn(step) + turn(step + 1) < 0.25 * curvature * (length(step) + beside);
}

/// Returns the ascending fractions of a step between two knots at which points are added. The
/// distances between the added points grow from `first` [m] at the beginning and `last` [m] at the
/// end towards the middle of the step. A spline of degree 5 oscillates about its points; between
/// equidistant knots, the oscillation shrinks from knot to knot by a factor of about 0.43. From
/// one added point to the next, the distance grows by less than 1/0.43, so that the oscillation of
/// the spline still shrinks.
std::vector<double> SharesOn(double length, double first, double last) {
  constexpr double kGrowth = 1.25;
  std::vector<double> begin;
  std::vector<double> end;
  double from = first;
  double to = length - last;
  double grown = first;
  double shrunk = last;
  while (from < to) {
    if (grown <= shrunk) {
      begin.push_back(from / length);
      grown *= kGrowth;
      from += grown;
    } else {
      end.push_back(to / length);
      shrunk *= kGrowth;
      to -= shrunk;
    }
  }
  begin.insert(begin.end(), end.rbegin(), end.rend());
  return begin;
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
  const std::vector<double> turns = TurnsOf(fitted, period);
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

std::vector<std::size_t> StraightSteps(const CurveBetweenKnots& curve, const ChordPoints& fitted,
                                       double period, double tolerance) {
  // A step between two knots, such as a straight of a track, is long if it is kLong times as long
  // as the median step.
  constexpr double kLong = 4.0;
  // If the polyline turns by more than kLargestTurn at an end of a step, this end may be a wrong
  // point.
  constexpr double kLargestTurn = 0.25 * kPi;
  const std::vector<double> turns = TurnsOf(fitted, period);
  const std::vector<double> lengths = StepsOf(fitted, period);
  const double median = Median(lengths);
  const bool has_aside = FindBulge(curve, fitted, period, tolerance).IsAside(tolerance);
  std::vector<std::size_t> straight;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const std::size_t next = (i + 1) % fitted.points.size();
    const bool is_long = lengths[i] > kLong * median && IsStraighter(turns, lengths, i, period);
    if ((!is_long && !has_aside) || std::max(turns[i], turns[next]) > kLargestTurn) {
      continue;
    }
    const Bulge own =
        BulgeAfter([&](double share) -> Vec2 { return curve(i, share); }, i, fitted.points[i],
                   fitted.points[next], std::max(turns[i], turns[next]));
    if (own.IsAside(tolerance) || (is_long && own.distance > tolerance)) {
      straight.push_back(i);
    }
  }
  return straight;
}

ChordPoints WithPointsOn(const ChordPoints& fitted, double period,
                         const std::vector<std::size_t>& steps) {
  const std::vector<double> lengths = StepsOf(fitted, period);
  const std::size_t count = lengths.size();
  ChordPoints filled;
  auto step = steps.begin();
  for (std::size_t i = 0; i < fitted.points.size(); ++i) {
    filled.u.push_back(fitted.u[i]);
    filled.points.push_back(fitted.points[i]);
    if (step == steps.end() || *step != i) {
      continue;
    }
    ++step;
    const auto length_at = [&](bool exists, std::size_t neighbor) {
      return std::min(exists ? lengths[neighbor % count] : lengths[i], lengths[i] / 3.0);
    };
    const Vec2 along = fitted.points[(i + 1) % fitted.points.size()] - fitted.points[i];
    for (const double share : SharesOn(lengths[i], length_at(period > 0.0 || i > 0, i + count - 1),
                                       length_at(period > 0.0 || i + 1 < count, i + 1))) {
      filled.u.push_back(fitted.u[i] + share * lengths[i]);
      filled.points.push_back(fitted.points[i] + share * along);
    }
  }
  return filled;
}

[[noreturn]] void RefuseBulge(const Bulge& bulge, const ChordPoints& fitted,
                              const DistinctPoints& distinct, const PathPoints& given,
                              double tolerance) {
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
  // A spline through points at equal distances along a polyline leaves the polyline by up to 0.29
  // of the distance, where the polyline turns back.
  const double step = std::min(3.0 * tolerance, Median(StepsOf(distinct.chords, 0.0)));
  FailFit("",
          fmt::format(
              "the spline swings up to {:.4g} m aside of the straight line of {:.4g} m from {} "
              "to {}; must be at most {:.4g} m with these turns. Is {} wrong? Else resample the "
              "points every {:.2g} m, which keeps to the straight lines, or use fit: polyline",
              bulge.distance, bulge.chord, NameOf(given, distinct.number[before]),
              NameOf(given, distinct.number[after]), bulge.plausible, NameOf(given, number), step),
          LineOf(given, number));
}

}  // namespace trackbed
