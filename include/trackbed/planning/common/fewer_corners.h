#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "trackbed/planning/common/corners.h"

namespace trackbed {

/// Room that the curve of a corner needs.
struct CornerRoom {
  double tangent = 0.0;  ///< Length of each adjacent leg that the corner's curve replaces [m].
  double gap = 0.0;      ///< Smallest distance of the corner's curve from the corner [m].
};

/// Conditions under which LeaveOutCloseWaypoints keeps a corner or leaves out a waypoint.
struct WaypointChoice {
  std::vector<Vec2> waypoints;  ///< The mission's waypoints, beginning with the start [m].
  double max_gap = 0.0;         ///< Largest distance of the polyline from each waypoint [m].
  /// Returns the least room that a corner needs; the argument is the corner's heading change [rad],
  /// positive and at most pi.
  std::function<CornerRoom(double)> room;
  /// Fraction of the polyline's first and last leg that the curve of a corner may use. The curve of
  /// a corner may use half of any other leg.
  double end_share = 1.0;
  /// Whether the first leg must keep its direction, for example for a car that starts straight
  /// along the first leg.
  bool keeps_first_direction = true;
  /// Heading of the car at the start [rad], if the path begins with a turn from this heading to the
  /// first leg. The turn at the start needs as much room as a corner.
  std::optional<double> start_yaw;
};

/// A path counts as passing a point if its distance from the point is at most this fraction of the
/// car's width.
inline constexpr double kUnnoticedShareOfWidth = 0.25;

/// Leaves out waypoints that are too close to each other for the curves that round their corners.
/// Keeps the first and the last point of the polyline. Keeps the direction of the first leg, unless
/// WaypointChoice::keeps_first_direction is false. A waypoint may be left out if it lies within
/// `max_gap` of the polyline's leg that bypasses it or of the polyline's first leg. Any other point
/// of the polyline may be left out if it lies on the leg that bypasses it or on the first leg.
/// Returns the polyline with the fewest corners that the car cannot drive at `min_speed`. If
/// several polylines have equally few undrivable corners, returns the one with the most points.
/// Among polylines with equally many undrivable corners and points, returns the polyline nearest to
/// the points left out. Cost: O(n w^2) for n points, of which at most w = 50 are left out in a row.
std::vector<Vec2> LeaveOutCloseWaypoints(const VehicleParams& vehicle,
                                         const std::vector<Vec2>& polyline,
                                         const CornerLimits& limits);

/// Same as LeaveOutCloseWaypoints above, but for corners of any shape. A corner counts as drivable
/// if its legs have the room that `choice.room` returns.
std::vector<Vec2> LeaveOutCloseWaypoints(const std::vector<Vec2>& polyline,
                                         const WaypointChoice& choice);

}  // namespace trackbed
