#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "trackbed/planning/common/corners.h"

namespace trackbed {

/// Room that the curve of a corner needs.
struct CornerRoom {
  double tangent = 0.0;  ///< Length of each leg that the curve replaces [m].
  double gap = 0.0;      ///< Distance of the curve from the corner [m].
};

/// Conditions under which LeaveOutCloseWaypoints keeps a corner or leaves out a waypoint.
struct WaypointChoice {
  std::vector<Vec2> waypoints;  ///< The mission's waypoints, beginning with the start [m].
  double max_gap = 0.0;         ///< Largest distance of the polyline from each waypoint [m].
  /// Returns the least room of a corner with a heading change, positive and at most pi [rad].
  std::function<CornerRoom(double)> room;
  /// Share of the first and of the last leg that a corner may use; half of each other leg.
  double end_share = 1.0;
  /// Whether the first leg keeps its direction, as for a car that starts straight along it.
  bool keeps_first_direction = true;
  /// Heading of the car at the start [rad], if the path begins with a turn from this heading to the
  /// first leg. The turn needs the room of a corner.
  std::optional<double> start_yaw;
};

/// Share of the car's width within which a path passes a point unnoticed.
inline constexpr double kUnnoticedShareOfWidth = 0.25;

/// Leaves out waypoints that are too close to each other for the curves of their corners. The first
/// and last point stay the same, and the direction of the first leg unless `choice` says otherwise.
/// A point may be left out if it is a waypoint within `max_gap` of the leg that replaces it or of
/// the first leg. A point may also be left out if it lies on one of these legs. Of all such
/// polylines, returns the one with the fewest corners that the car cannot drive at `min_speed`. Of
/// polylines with equally many such corners, returns the one with the most points, and among these
/// the one that is nearest to the points left out. Cost: O(n w^2) for n points, of which at most w
/// = 50 are left out in a row.
std::vector<Vec2> LeaveOutCloseWaypoints(const VehicleParams& vehicle,
                                         const std::vector<Vec2>& polyline,
                                         const CornerLimits& limits);

/// Same, for corners of any shape: a corner counts as drivable if `choice.room` says so.
std::vector<Vec2> LeaveOutCloseWaypoints(const std::vector<Vec2>& polyline,
                                         const WaypointChoice& choice);

}  // namespace trackbed
