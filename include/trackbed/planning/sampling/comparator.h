#pragma once

#include <vector>

#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/sampling/comparator_options.h"
#include "trackbed/planning/sampling/smoothing.h"

/// Chooses between two paths ("Comparator" of the wind-aware RRT): the shorter one, with collisions
/// and wind converted to meters.
namespace trackbed {

/// The score of the rest of a path, for a car.
struct PathScore {
  /// Length L [m]: the distance to the path's nearest point, and from there along the path.
  double length = 0.0;
  bool collides = false;  ///< Whether the rest of the path comes too close to an obstacle.
  double wind = 0.0;      ///< Wind score W of the rest of the path [m].
  double total = 0.0;     ///< Score L - W, plus the penalty [m].
};

void Visit(DiagnosticsVisitor& out, const PathScore& score);

/// Scores a path for a car at `position`, from the path's nearest point on. The original listing
/// starts at the nearest corner, which may lie behind the car or far ahead. A path that comes
/// closer to an obstacle than `inflation` [m] collides. InternalError for a path without points.
PathScore ScorePath(const std::vector<Vec2>& way, const Vec2& position,
                    const std::vector<OrientedBox>& obstacles, double inflation,
                    const WindScoring& wind, const ComparatorOptions& options);

/// Whether another path is better than the current one. In a tie, the current path stays.
inline bool IsBetter(const PathScore& other, const PathScore& current) {
  return other.total < current.total;
}

}  // namespace trackbed
