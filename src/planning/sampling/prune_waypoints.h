#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/sampling/smoothing.h"

/// Removes waypoints from a path with many corners, because a car needs legs on which to turn its
/// wheels.
namespace trackbed {

/// Position of the path in the whole polyline, and the costs of the path.
struct PruningProblem {
  std::optional<Vec2> before;  ///< Point of the polyline before the first point of the path.
  bool first_leg = true;       ///< The path's first leg is the polyline's first leg.
  bool last_leg = true;        ///< The path's last leg is the polyline's last leg.
  const std::vector<OrientedBox>& obstacles;
  double inflation = 0.0;  ///< Required distance of the lines from all obstacles [m].
  const WindScoring& wind;
  double corner_cost = 0.0;               ///< Cost of a corner [m].
  std::function<double(double)> tangent;  ///< Least tangent length [m] of a corner with
                                          ///< heading change |h| [rad]: see CornerAt
};

/// The cheapest path along free straight lines between points of the given path, in their order.
/// The cost is the length, less the wind score, plus the corner cost per line. Lines share their
/// length between corners as in RoundCorners. The path has a corner that does not fit on its lines
/// only if no other path exists. The function assumes that the given path's own lines are free.
/// Cost: O(n^3) for n points and O(n^2 x obstacles).
std::vector<Vec2> PruneWaypoints(const std::vector<Vec2>& way, const PruningProblem& problem);

/// Splits a path into pieces short enough for a uniform wind along each piece.
std::vector<Vec2> InPieces(const std::vector<Vec2>& way);

}  // namespace trackbed
