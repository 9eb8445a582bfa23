#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/path.h"

/// Finds where a path takes a long way from one waypoint to the next.
namespace trackbed {

/// The part of a path between two successive waypoints.
struct LongLeg {
  std::size_t to = 0;     ///< Index of the waypoint at its end in the route, >= 1.
  double length = 0.0;    ///< Length of the path between the waypoints [m].
  double straight = 0.0;  ///< Distance between the waypoints [m].
};

/// Returns the leg on which the path exceeds the straight line between its waypoints by the largest
/// length; nullopt if no leg exceeds it by `excess` [m] > 0, or if there are fewer than two
/// waypoints. The path passes the waypoints in their order, each where the sum of all distances is
/// smallest; it starts at the first waypoint and ends at the last one. The lengths are multiples of
/// a spacing of at most a sixteenth of `excess`, or of a ten thousandth of the path.
/// Cost: proportional to the number of waypoints times length/excess; nothing but the lengths of
/// the lines if the whole path is short enough.
std::optional<LongLeg> LongestLeg(const Path& path, const std::vector<Vec2>& waypoints,
                                  double excess);

}  // namespace trackbed
