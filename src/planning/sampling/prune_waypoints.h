#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/sampling/smoothing.h"

/// Removes waypoints from a path with many corners, because a car needs legs that are long enough
/// for turning its wheels.
namespace trackbed {

/// The problem of PruneWaypoints: how the path continues in the whole polyline, and what a path
/// costs.
struct PruningProblem {
  std::optional<Vec2> before;  ///< Point of the polyline before the first point of the path.
  bool first_leg = true;       ///< Whether the path's first leg is the polyline's first leg.
  bool last_leg = true;        ///< Whether the path's last leg is the polyline's last leg.
  const std::vector<OrientedBox>& obstacles;
  double inflation = 0.0;  ///< Required distance of the lines from all obstacles [m].
  const WindScoring& wind;
  double corner_cost = 0.0;               ///< Cost of a corner [m].
  std::function<double(double)> tangent;  ///< Least tangent length [m] of a corner with
                                          ///< heading change |h| [rad]: see CornerAt
};

/// Finds the cheapest path along collision-free straight lines that visits a subset of the given
/// points in their order. The cost is the length, minus the wind score, plus the corner cost per
/// line. As in RoundCorners, each corner may use half of each of its lines. The result contains a
/// corner that does not fit on its lines only if every other path does too. PruneWaypoints assumes
/// that the lines of the given path are collision-free. Cost: O(n^3) for n points and O(n^2 x
/// obstacles).
std::vector<Vec2> PruneWaypoints(const std::vector<Vec2>& way, const PruningProblem& problem);

/// Splits a path into pieces that are so short that the wind is nearly uniform along each piece.
std::vector<Vec2> InPieces(const std::vector<Vec2>& way);

}  // namespace trackbed
