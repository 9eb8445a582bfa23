#pragma once

#include <vector>

#include "src/path_files/lanelets.h"

namespace trackbed {

/// Returns points for a car's center, about 1 m apart [m]. The points lead from the pose `start`
/// onto the centers of the first lane, and from lane to lane. The points extend `beyond` [m]
/// further than the end of the last lane, along the straightest successors, then straight ahead.
/// The car keeps to about 1.5 m/s^2 of lateral acceleration at `speed` [m/s] where it moves to a
/// lane's center, if the lanelets are long enough. If `aim` is given, the path leaves the center of
/// the last lane, with about 1.5 m/s^2 as well, and reaches the place `aim`.
std::vector<Vec2> LaneletPath(const Lanelets& lanelets, const std::vector<LaneletLane>& lanes,
                              const Pose2& start, const std::optional<Vec2>& aim, double speed,
                              double beyond);

}  // namespace trackbed
