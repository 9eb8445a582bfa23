#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/path/fit_path.h"

namespace trackbed {

/// A stretch of the given points that the car drives in one direction. The car changes its
/// direction at the last point of a leg, which is also the first point of the next leg.
struct Leg {
  std::size_t first = 0;  ///< Index of the leg's first point.
  std::size_t last = 0;   ///< Index of the leg's last point.
  int direction = 1;      ///< Direction of motion: +1 forwards, -1 backwards.
};

/// Finds the legs of the given points from their directions and headings. Without directions and
/// headings, all points form one forward leg. A reverse piece shorter than `noise` [m] is regarded
/// as noise of the positions. FindLegs costs O(n) for n points.
std::vector<Leg> FindLegs(const PathPoints& given, double noise);

/// Returns the points of a leg and their line numbers.
PathPoints PointsOf(const PathPoints& given, const Leg& leg);

/// Returns the segments of a path that is followed in the given direction. The segments of
/// `forward` describe the curve in the direction of travel.
std::vector<Segment> InDirection(std::vector<Segment> forward, int direction);

}  // namespace trackbed
