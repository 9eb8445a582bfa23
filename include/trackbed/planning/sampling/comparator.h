#pragma once

#include <vector>

#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/sampling/comparator_options.h"
#include "trackbed/planning/sampling/smoothing.h"

/// Compares two paths by their lengths, with collisions and wind converted to lengths ("Comparator"
/// of the wind-aware RRT).
namespace trackbed {

/// The score of the part of a path that lies ahead of a car; a lower score is better.
struct PathScore {
  /// Length L [m], which is the distance from the car to the path's nearest point plus the length
  /// of the path beyond this point.
  double length = 0.0;
  bool collides = false;  ///< Whether the path ahead of the car comes too close to an obstacle.
  double wind = 0.0;      ///< Wind score W of the path ahead of the car (smoothing.h) [m].
  /// Total score: the length L minus the wind score W, plus a penalty if the path collides [m].
  double total = 0.0;
};

void Visit(DiagnosticsVisitor& out, const PathScore& score);

/// Scores a path for a car at `position`, from the point of the path that is nearest to the car.
/// The code listing of the wind-aware RRT scores a path from the corner nearest to the car instead,
/// which may lie behind the car or far ahead. A path collides if it comes closer to an obstacle
/// than `inflation`. Throws InternalError if the path has no points.
PathScore ScorePath(const std::vector<Vec2>& way, const Vec2& position,
                    const std::vector<OrientedBox>& obstacles, const Inflation& inflation,
                    const WindScoring& wind, const ComparatorOptions& options);

/// Returns whether another path has a lower total score than the current path.
inline bool IsBetter(const PathScore& other, const PathScore& current) {
  return other.total < current.total;
}

}  // namespace trackbed
