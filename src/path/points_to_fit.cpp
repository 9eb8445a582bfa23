#include "src/path/points_to_fit.h"

#include <fmt/format.h>

#include <utility>

#include "trackbed/core/error.h"

// Prepares the points of a file for a fit: drops repeated points, and resamples points along
// straight lines.

namespace trackbed {
namespace {

/// Returns the point on the polyline at chord length u.
Vec2 OnLines(const ChordPoints& chords, double u) {
  const std::size_t i = LastBefore(chords.u, u);
  if (i + 1 == chords.u.size()) {
    return chords.points.back();
  }
  const double share = (u - chords.u[i]) / (chords.u[i + 1] - chords.u[i]);
  return chords.points[i] + share * (chords.points[i + 1] - chords.points[i]);
}

}  // namespace

[[noreturn]] void FailFit(const std::string& key, std::string message, int line) {
  throw InputError(Problem{.line = line, .key = key, .message = std::move(message)});
}

int LineOf(const PathPoints& given, std::size_t point) {
  return given.lines.empty() ? 0 : given.lines[point];
}

std::string NameOf(const PathPoints& given, std::size_t point) {
  const Vec2& at = given.points[point];
  const int line = LineOf(given, point);
  return fmt::format("{} {} at ({:.6g}, {:.6g})", line > 0 ? "row" : "point",
                     line > 0 ? static_cast<std::size_t>(line) : point + 1, at.x(), at.y());
}

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
  distinct.repeated = given.points.size() - chords.points.size();
  if (closed && chords.points.size() > 2) {
    double gap = (chords.points.front() - chords.points.back()).norm();
    if (gap <= kEqualityTolerance) {
      chords.points.pop_back();
      gap = chords.u.back() - *(chords.u.end() - 2);
      chords.u.pop_back();
      distinct.number.pop_back();
      ++distinct.repeated;
    }
    distinct.period = chords.u.back() + gap;
  }
  return distinct;
}

std::size_t LastBefore(const std::vector<double>& rising, double u) {
  const auto after = std::upper_bound(rising.begin(), rising.end(), u);
  return static_cast<std::size_t>(after - rising.begin()) - 1;
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
  FailFit(
      "",
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
    FailFit("resample", fmt::format("{:.4g} m every {:.4g} m are more than {} points", length,
                                    spacing, kMaxFittedPoints));
  }
  ChordPoints resampled;
  const double last = distinct.period > 0.0 ? count - 1.0 : count;
  for (double i = 0.0; i <= last; i += 1.0) {
    resampled.u.push_back(length * i / count);
    resampled.points.push_back(OnLines(lines, resampled.u.back()));
  }
  return resampled;
}

}  // namespace trackbed
