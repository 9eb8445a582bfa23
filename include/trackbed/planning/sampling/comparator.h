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
  double length = 0.0;    ///< L: to the path's nearest point, and along it from there [m]
  bool collides = false;  ///< the rest of the path comes too close to an obstacle
  double wind = 0.0;      ///< W of the rest of the path [m]
  double total = 0.0;     ///< L - W, plus the penalty [m]
};

void Visit(DiagnosticsVisitor& out, const PathScore& score);

/// The score of a path for a car at `position`, from the path's nearest point on. The listing
/// counts from the nearest corner, which may lie behind the car or far ahead. `inflation` [m] is
/// the distance from an obstacle that counts as a collision. InternalError for a path without
/// points.
PathScore ScorePath(const std::vector<Vec2>& way, const Vec2& position,
                    const std::vector<OrientedBox>& obstacles, double inflation,
                    const WindScoring& wind, const ComparatorOptions& options);

/// Whether another path is better than the current one; ties keep the current path.
inline bool IsBetter(const PathScore& other, const PathScore& current) {
  return other.total < current.total;
}

}  // namespace trackbed
