#pragma once

#include <vector>

#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/sampling/comparator_options.h"
#include "trackbed/planning/sampling/smoothing.h"

/// Chooses the shorter one of two paths ("Comparator" of the wind-aware RRT). Collisions and wind
/// are converted to lengths.
namespace trackbed {

/// The score of the part of a path that lies ahead of a car.
struct PathScore {
  /// Length L [m]: the distance from the car to the path's nearest point, plus the length of the
  /// path beyond this point.
  double length = 0.0;
  bool collides = false;  ///< Whether the rest of the path comes too close to an obstacle.
  double wind = 0.0;      ///< Wind score W of the rest of the path [m].
  double total = 0.0;     ///< Score L - W, plus the penalty [m].
};

void Visit(DiagnosticsVisitor& out, const PathScore& score);

/// Scores a path for a car at `position`, from the point of the path that is nearest to the car. In
/// contrast, the original listing scores a path from the nearest corner, which may lie behind the
/// car or far ahead. A path collides if it comes closer to an obstacle than `inflation` [m]. Throws
/// InternalError for a path without points.
PathScore ScorePath(const std::vector<Vec2>& way, const Vec2& position,
                    const std::vector<OrientedBox>& obstacles, double inflation,
                    const WindScoring& wind, const ComparatorOptions& options);

/// Returns whether another path is better than the current path. If both totals are equal, the
/// current path stays.
inline bool IsBetter(const PathScore& other, const PathScore& current) {
  return other.total < current.total;
}

}  // namespace trackbed
