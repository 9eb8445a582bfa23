#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "trackbed/geometry/box_index.h"
#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/sampling/smoothing.h"

/// Removes waypoints from a path with many corners, because a car needs legs that are long enough
/// for turning its wheels.
namespace trackbed {

/// Input of PruneWaypoints: the position of the path within the whole polyline, and the parameters
/// of a path's cost.
struct PruningProblem {
  /// Point of the whole polyline just before the first point of the path.
  std::optional<Vec2> before;
  /// Whether the first leg of the path is also the first leg of the whole polyline.
  bool first_leg = true;
  /// Whether the last leg of the path is also the last leg of the whole polyline.
  bool last_leg = true;
  const std::vector<OrientedBox>& obstacles;
  Inflation inflation = 0.0;  ///< Distance that the path must keep from the obstacles.
  const WindScoring& wind;
  double corner_cost = 0.0;  ///< Cost of each line of the path, which penalizes corners [m].
  /// Returns the minimum tangent length [m] of a corner for its heading change |h| [rad]; see
  /// CornerAt
  std::function<double(double)> tangent;
};

/// The number of lines of a path that PruneWaypoints considers at once.
inline constexpr std::size_t kPruningWindow = 300;

/// Finds the cheapest path along collision-free straight lines that visits a subset of the given
/// points in their order. The cost of a path is its length, minus the wind score, plus the corner
/// cost for each line. As in RoundCorners, each corner may use half of each of the two adjacent
/// lines. The result contains a corner that does not fit on the adjacent lines only if every
/// possible path contains such a corner. PruneWaypoints assumes that the lines of the given path
/// are collision-free. Paths of more than kPruningWindow lines are divided into windows of this
/// number of lines. With several windows, the result contains the ends of all windows, and is the
/// cheapest path only within each window. The computing time per window of n points is O(n^3) plus
/// O(n^2 x obstacles).
std::vector<Vec2> PruneWaypoints(const std::vector<Vec2>& way, const PruningProblem& problem);

/// Largest number of points of a path that JoinCloseCorners changes.
inline constexpr std::size_t kJoinedPoints = kPruningWindow / 8;

/// Replaces successive corners that do not fit on the lines between them. New corners are the
/// points at which lines of the path meet if they are extended: two sharp corners around the end of
/// a wall become one corner farther outside. Returns the cheapest path through the given points and
/// the new corners, with the path cost of PruneWaypoints. Returns the path unchanged if all of its
/// corners fit, or if it has more than kJoinedPoints points. The computing time is that of
/// PruneWaypoints for eight times as many points.
std::vector<Vec2> JoinCloseCorners(const std::vector<Vec2>& way, const PruningProblem& problem);

/// Splits a path into pieces that are so short that the wind is nearly uniform along each piece.
std::vector<Vec2> InPieces(const std::vector<Vec2>& way);

}  // namespace trackbed
