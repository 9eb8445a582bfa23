#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/path/path.h"

/// Measures how far a path passes from the waypoints of its route.
///
/// The distance of a path from a waypoint is the smallest distance between the waypoint and the
/// rear axle's path. The order in which the path passes the waypoints does not affect their
/// distances. The first waypoint is the start of the route, so its distance from the path is not
/// measured.
namespace trackbed {

/// The distance of a path from one waypoint.
struct WaypointMiss {
  std::size_t waypoint = 0;  ///< Index of the waypoint in the route, >= 1.
  Vec2 at{0.0, 0.0};         ///< Position of the waypoint [m].
  double distance = 0.0;     ///< Smallest distance between the path and the waypoint [m].
  double station = 0.0;      ///< Station at which the path is nearest to the waypoint [m].
};

/// Distances from waypoints that differ by less than kSameMiss [m] count as equal, because rounding
/// errors of a path far from the origin may reach this value.
inline constexpr double kSameMiss = 1e-6;

/// Returns the waypoint from which the path is farthest, or the first of several such waypoints
/// (kSameMiss); nullopt if there are fewer than two waypoints. The distance is exact on lines and
/// arcs, and has the precision of Path::Project on other segments. Throws PreconditionError if a
/// waypoint is not finite. Cost: for each waypoint, about the square root of the number of the
/// path's segments, if the path passes each place only a few times.
std::optional<WaypointMiss> LargestWaypointMiss(const Path& path,
                                                const std::vector<Vec2>& waypoints);

/// Formats a waypoint for messages, for example "waypoint 1 at (60, 0)".
std::string DescribeWaypoint(std::size_t waypoint, const Vec2& at);

/// Formats the remedies against a missed waypoint, for example "set plan.max_waypoint_miss to at
/// least 24.4, or move the waypoint". The argument `distance` is the smallest possible distance of
/// the path from the waypoint [m], which the message rounds up.
std::string RemedyForMiss(double distance);

}  // namespace trackbed
