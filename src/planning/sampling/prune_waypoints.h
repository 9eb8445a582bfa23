#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/sampling/smoothing.h"

/// What is left of a path of many corners for a car, which needs legs to turn its wheels on.
namespace trackbed {

/// Where the way stands in the whole polyline, and what it costs.
struct PruningProblem {
  std::optional<Vec2> before;  ///< the polyline's point before the path's first one
  bool first_leg = true;       ///< it is the polyline's first
  bool last_leg = true;        ///< the path's end is the polyline's
  const std::vector<OrientedBox>& obstacles;
  double inflation = 0.0;  ///< the lines keep further than this from all obstacles [m]
  const WindScoring& wind;
  double corner_cost = 0.0;               ///< [m]
  std::function<double(double)> tangent;  ///< least tangent length [m] of a corner that turns by
                                          ///< |h| [rad]: see CornerAt
};

/// Of all paths along free straight lines from points of the given path to later ones the one of
/// the least length, less wind score, plus corner cost per line; corners for which their lines
/// leave no room, as RoundCorners shares it, are taken only where there is no other way. The way's
/// own lines are taken to be free. Cost O(n^3) for n points and O(n^2 x obstacles).
std::vector<Vec2> PruneWaypoints(const std::vector<Vec2>& way, const PruningProblem& problem);

/// The same way in pieces short enough for the wind to be the same all along each.
std::vector<Vec2> InPieces(const std::vector<Vec2>& way);

}  // namespace trackbed
