#pragma once

#include <vector>

#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/sampling/comparator_options.h"
#include "trackbed/planning/sampling/smoothing.h"

/// Which of two ways to go on with ("Comparator" of the wind-aware RRT): the shorter one, where a
/// collision and the wind count in meters.
namespace trackbed {

/// What a path has left for a car.
struct PathScore {
  double length = 0.0;    ///< L: to the path's nearest point, and along it from there [m]
  bool collides = false;  ///< what is left of it comes too close to an obstacle
  double wind = 0.0;      ///< W of what is left of it [m]
  double total = 0.0;     ///< L - W, and the penalty [m]
};

void Visit(DiagnosticsVisitor& out, const PathScore& score);

/// The score of a path for a car at `position`. That listing counts from the path's nearest corner,
/// which may lie behind the car or far ahead; here it is the nearest point. `inflation` [m]: how
/// close to an obstacle is too close. InternalError for a path without points.
PathScore ScorePath(const std::vector<Vec2>& way, const Vec2& position,
                    const std::vector<OrientedBox>& obstacles, double inflation,
                    const WindScoring& wind, const ComparatorOptions& options);

/// Whether to leave the current way for another: if that is better; on ties it is kept.
inline bool IsBetter(const PathScore& other, const PathScore& current) {
  return other.total < current.total;
}

}  // namespace trackbed
