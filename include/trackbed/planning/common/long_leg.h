#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/path.h"

/// Finds the waypoints between which a path makes a long detour.
namespace trackbed {

/// The part of a path between two successive waypoints.
struct LongLeg {
  std::size_t to = 0;     ///< Index of the waypoint at which this leg ends, >= 1.
  double length = 0.0;    ///< Length of the path between the waypoints [m].
  double straight = 0.0;  ///< Distance between the waypoints [m].
};

/// Returns the leg with the largest extra length, which is the length of the path minus the length
/// of the straight line between the leg's waypoints. Returns nullopt if every extra length is below
/// `excess` [m], > 0, or if there are fewer than two waypoints. The path starts at the first
/// waypoint, passes the waypoints in their order, and ends at the last waypoint. The stations of
/// the waypoints are those for which the sum of the distances between path and waypoints is
/// smallest. Computed lengths are multiples of a sample spacing, which is at most a sixteenth of
/// `excess` or, if larger, a ten thousandth of the path. Computing time: proportional to the number
/// of waypoints times the number of path samples, at most 10 000. Memory: proportional to the
/// number of waypoints plus the number of path samples. If the whole path exceeds the straight
/// lines by less than `excess`, the function returns nullopt at once.
std::optional<LongLeg> LongestLeg(const Path& path, const std::vector<Vec2>& waypoints,
                                  double excess);

}  // namespace trackbed
