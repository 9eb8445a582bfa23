#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/sampling/smoothing.h"

/// Removes waypoints from a path with many corners; a car needs legs to turn its wheels on.
namespace trackbed {

/// Position of the path in the whole polyline, and its costs.
struct PruningProblem {
  std::optional<Vec2> before;  ///< the polyline's point before the path's first one
  bool first_leg = true;       ///< the path's first leg is the polyline's
  bool last_leg = true;        ///< the path's last leg is the polyline's
  const std::vector<OrientedBox>& obstacles;
  double inflation = 0.0;  ///< required distance of the lines from all obstacles [m]
  const WindScoring& wind;
  double corner_cost = 0.0;               ///< [m]
  std::function<double(double)> tangent;  ///< least tangent length [m] of a corner with
                                          ///< heading change |h| [rad]: see CornerAt
};

/// The cheapest path along free straight lines between points of the given path, in their order.
/// The cost is the length, less the wind score, plus the corner cost per line. Corners that do not
/// fit on their lines, shared as in RoundCorners, are chosen only if there is no other path. The
/// path's own lines are assumed to be free. Cost: O(n^3) for n points and O(n^2 x obstacles).
std::vector<Vec2> PruneWaypoints(const std::vector<Vec2>& way, const PruningProblem& problem);

/// Splits a path into pieces short enough for a uniform wind along each.
std::vector<Vec2> InPieces(const std::vector<Vec2>& way);

}  // namespace trackbed
