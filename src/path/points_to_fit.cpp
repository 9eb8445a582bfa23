#include "src/path/points_to_fit.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "trackbed/core/error.h"

// Prepares the points of a file for a path fit. Removes repeated points, merges points of noise,
// omits points that are too close together, and resamples points along straight lines.
//
// Noise is detected by steps between points that turn back, as recorded from a car that stands or
// creeps. Groups of consecutive points are kept on a stack. A group of points at which the polyline
// turns by more than a right angle absorbs neighboring groups while the common bounding box is
// small enough. The merging of groups is repeated until no group changes.

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

/// Consecutive points that one point replaces.
struct PointGroup {
  Vec2 low;
  Vec2 high;
  std::size_t begin = 0;      // Index of the group's first point in the given points.
  std::size_t count = 1;      // Number of distinct points in the group.
  bool is_noise = false;      // Whether a step within the group turned back.
  std::optional<Vec2> end{};  // Position of a group that contains an end of an open path.

  [[nodiscard]] Vec2 At() const { return end ? *end : Vec2(0.5 * (low + high)); }
};

/// Returns the union of two groups of points.
PointGroup Merged(const PointGroup& a, const PointGroup& b) {
  PointGroup both = a;
  both.low = a.low.cwiseMin(b.low);
  both.high = a.high.cwiseMax(b.high);
  both.count = a.count + b.count;
  both.is_noise = true;
  both.end = a.end ? a.end : b.end;
  return both;
}

/// Returns whether two groups of points can be merged: their common box must be small and must not
/// contain both ends of the path.
bool CanMerge(const PointGroup& a, const PointGroup& b, double noise) {
  const PointGroup both = Merged(a, b);
  return (both.high - both.low).norm() <= noise && !(a.end && b.end);
}

bool TurnsBack(const PointGroup& a, const PointGroup& b, const PointGroup& c) {
  return (b.At() - a.At()).dot(c.At() - b.At()) < 0.0;
}

/// Merges each group of points at which the polyline turns back with its neighbors. Returns whether
/// any groups were merged.
bool MergePass(std::vector<PointGroup>& groups, double noise) {
  std::vector<PointGroup> kept;
  const auto merge_last = [&] {
    kept[kept.size() - 2] = Merged(kept[kept.size() - 2], kept.back());
    kept.pop_back();
  };
  const auto can_merge_last = [&] {
    return kept.size() > 1 && CanMerge(kept[kept.size() - 2], kept.back(), noise);
  };
  for (const PointGroup& group : groups) {
    kept.push_back(group);
    const std::size_t count = kept.size();
    if (count > 1 && kept[count - 2].is_noise && can_merge_last()) {
      merge_last();
    } else if (count > 2 && TurnsBack(kept[count - 3], kept[count - 2], kept[count - 1])) {
      kept.pop_back();
      while (can_merge_last()) {
        merge_last();
      }
      kept.push_back(group);
      if (can_merge_last()) {
        merge_last();
      }
    }
  }
  const bool has_merged = kept.size() < groups.size();
  groups = std::move(kept);
  return has_merged;
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

PathPoints AtStandstills(PathPoints given, double noise) {
  const std::size_t count = given.speed.size();
  for (std::size_t first = 0, end = 0; first < count; first = end) {
    end = first + 1;
    if (given.speed[first] > 0.0) {
      continue;
    }
    Vec2 low = given.points[first];
    Vec2 high = low;
    for (; end < count && !(given.speed[end] > 0.0); ++end) {
      low = low.cwiseMin(given.points[end]);
      high = high.cwiseMax(given.points[end]);
    }
    const Vec2 place = first == 0     ? given.points.front()
                       : end == count ? given.points.back()
                                      : Vec2(0.5 * (low + high));
    const auto begin = given.points.begin();
    const auto from = begin + static_cast<std::ptrdiff_t>(first);
    const auto to = begin + static_cast<std::ptrdiff_t>(end);
    if ((first > 0 || end < count) &&
        std::all_of(from, to, [&](const Vec2& own) { return (own - place).norm() <= noise; })) {
      std::fill(from, to, place);
    }
  }
  return given;
}

DistinctPoints Distinct(const PathPoints& given, bool closed, double noise) {
  DistinctPoints distinct;
  std::vector<PointGroup> groups;
  for (std::size_t i = 0; i < given.points.size(); ++i) {
    const Vec2& point = given.points[i];
    if (groups.empty() || (point - groups.back().low).norm() > kEqualityTolerance) {
      groups.push_back({.low = point, .high = point, .begin = i});
    }
  }
  distinct.repeated = given.points.size() - groups.size();
  if (!groups.empty() && !closed) {
    groups.front().end = groups.front().low;
    groups.back().end = groups.back().low;
  }
  while (MergePass(groups, noise)) {
  }
  ChordPoints& chords = distinct.chords;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const Vec2 point = groups[i].At();
    chords.u.push_back(i == 0 ? 0.0 : chords.u.back() + (point - chords.points.back()).norm());
    chords.points.push_back(point);
    distinct.number.push_back(groups[i].begin);
    distinct.merged += groups[i].count - 1;
    const std::size_t end = i + 1 < groups.size() ? groups[i + 1].begin : given.points.size();
    distinct.given_u.resize(end, chords.u.back());
  }
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

ChordPoints Spaced(const DistinctPoints& distinct, double spacing) {
  const ChordPoints& all = distinct.chords;
  const double end = distinct.period > 0.0 ? distinct.period : all.u.back();
  ChordPoints spaced;
  for (std::size_t i = 0; i < all.u.size(); ++i) {
    const bool is_far =
        i == 0 || (all.u[i] - spaced.u.back() >= spacing && end - all.u[i] >= spacing);
    const bool is_end = distinct.period == 0.0 && i + 1 == all.u.size();
    if (is_far || is_end) {
      spaced.u.push_back(all.u[i]);
      spaced.points.push_back(all.points[i]);
    }
  }
  constexpr std::size_t kFewest = 4;
  return spaced.u.size() < kFewest ? all : spaced;
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
