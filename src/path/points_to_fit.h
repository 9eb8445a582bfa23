#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "src/path/smoothing_spline.h"
#include "trackbed/path/fit_path.h"

namespace trackbed {

/// Throws InputError with the given key, message and line number of the input file.
[[noreturn]] void FailFit(const std::string& key, std::string message, int line = 0);

/// Returns the number of the line that defines a point in the input file; 0 if the line number is
/// unknown.
int LineOf(const PathPoints& given, std::size_t point);

/// Describes a point for error messages, such as "row 7 at (1, 2)", or "point 6 at (1, 2)" if line
/// numbers are not known.
std::string NameOf(const PathPoints& given, std::size_t point);

/// Moves each run of successive points with the speed 0, at which the car stands, to one position.
/// The common position is the center of the run's bounding box, or the first or last point of the
/// path. If a point is farther than `noise` [m] from the common position, the run's points stay
/// unchanged, because the car may have moved. Points without speeds are returned unchanged.
PathPoints AtStandstills(PathPoints given, double noise);

/// The given points without repeated points and without noise that turns back, with the chord
/// length at each point.
struct DistinctPoints {
  ChordPoints chords;
  std::vector<std::size_t> number;  // Index of each distinct point among the given points.
  std::vector<double> given_u;      // Chord length at the distinct point of each given point.
  double period = 0.0;              // Period of a closed path [m]; 0 for an open path.
  std::size_t repeated = 0;         // Number of points that equal the preceding point.
  std::size_t merged = 0;           // Number of points that were merged with their neighbors.
};

/// Removes repeated points and merges noisy points. Steps between points that turn back by more
/// than a right angle within `noise` [m] are regarded as noise of the positions. The points around
/// a noisy step, within a box with the diagonal `noise`, are replaced by the center of the box. The
/// first and the last point of an open path keep their positions.
DistinctPoints Distinct(const PathPoints& given, bool closed, double noise);

/// Returns the index of the last element that is at most u, for u >= 0 and an ascending list that
/// begins with 0.
std::size_t LastBefore(const std::vector<double>& rising, double u);

/// Throws InputError if the path is longer than kMaxPathLength.
void CheckLength(const DistinctPoints& distinct, const PathPoints& given);

/// Removes points that are closer than `spacing` [m], in chord length, to the previous kept point
/// or to the end. The first point, and the last point of an open path, are always kept. Spaced
/// returns all points if fewer than four would remain.
ChordPoints Spaced(const DistinctPoints& distinct, double spacing);

/// Returns points that are `spacing` [m] apart on the straight lines between the distinct points.
ChordPoints Resampled(const DistinctPoints& distinct, double spacing);

/// Calls `call` with the index, the change of direction and the length of the shorter line at each
/// inner point of the polyline. On a closed path, every point is an inner point.
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

/// Distance [m] below which a point is regarded as a repetition of the preceding point.
inline constexpr double kEqualityTolerance = 1e-9;

/// Maximum number of points to which a path is fitted.
inline constexpr std::size_t kMaxFittedPoints = 200'000;

}  // namespace trackbed
