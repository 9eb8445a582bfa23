#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/geometry/box_index.h"
#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/common/plan_status.h"
#include "trackbed/vehicle/params.h"

/// Makes polylines drivable: replaces every corner by a clothoid, an arc and a second clothoid.
///
/// Symbols, for a corner that the car drives at the speed v [m/s]: h is the heading change [rad];
/// kappa is the peak curvature [1/m]; sigma = omega_delta/(L v) is the sharpness dkappa/ds of the
/// clothoids [1/m^2], at which the steering rate stays within its limit omega_delta; T is the
/// tangent length [m], the distance from the corner to either end of its curve.
namespace trackbed {

/// Selects how a planner handles the corners of a polyline.
enum class Corners {
  /// Corners are rounded so that the car can drive them, if necessary below the planned speed.
  kRound,
  kRefuse,  ///< The planner rejects paths that have corners.
};

struct CornerLimits {
  double speed = 3.0;          ///< Upper limit of the speed v in a corner [m/s].
  double min_speed = 0.5;      ///< Lower limit of the speed v in a corner [m/s].
  double max_curvature = 0.2;  ///< Upper limit of the curvature in a corner [1/m].
  /// Speed of the car at the first point of the polyline [m/s]; 0: at rest. The path stays straight
  /// until the car has braked for the first corner.
  double start_speed = 0.0;
  double deceleration = 1.0;  ///< Deceleration of the car before the first corner [m/s^2], > 0.
  /// Waypoints of the route [m]; the bound `max_gap` applies to corners that lie at a waypoint.
  std::vector<Vec2> waypoints{};
  /// Upper limit of the distance between a waypoint and the curve that rounds the corner there [m],
  /// >= 0.
  double max_gap = std::numeric_limits<double>::infinity();
};

/// A rounded corner.
struct RoundCorner {
  Vec2 at{0.0, 0.0};            ///< Position of the corner on the polyline [m].
  double heading_change = 0.0;  ///< Heading change h at the corner [rad], positive to the left.
  double speed = 0.0;           ///< Speed v of the car in the corner [m/s].
  double sharpness = 0.0;       ///< Magnitude of the clothoids' sharpness sigma [1/m^2].
  double curvature = 0.0;       ///< Magnitude of the curve's peak curvature kappa [1/m].
  /// Tangent length T, from the corner to either end of its curve [m].
  double tangent_length = 0.0;
  double gap = 0.0;   ///< Smallest distance of the rounding curve from the corner [m].
  double from = 0.0;  ///< Station of the rounding curve's start [m].
  double to = 0.0;    ///< Station of the rounding curve's end [m].
};
void Visit(DiagnosticsVisitor& out, const RoundCorner& corner);

struct RoundedCorners {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;  ///< Reason why rounding failed; empty if ok.
  /// Index of the polyline's point at which a waypoint is missed, or at which the polyline turns
  /// back on itself; nullopt if rounding failed for another reason.
  std::optional<std::size_t> sharp_corner{};
  Path path;
  std::vector<RoundCorner> corners;
  /// Speed caps for the corners in which the car must drive below the speed limit.
  std::vector<SpeedCap> caps;
};

/// Computes the curve that rounds a corner of heading change |h| in (0, pi) for a car with the
/// speed v. The peak curvature of the curve is sqrt(|h| sigma), with the sharpness sigma of the
/// clothoids. If sqrt(|h| sigma) exceeds `max_curvature`, the curve has an arc of the maximum
/// curvature between the clothoids. The tangent length of the curve grows with the speed v.
RoundCorner CornerAt(const VehicleParams& vehicle, double heading_change, double speed,
                     double max_curvature);

/// Rounds the corners of a polyline. The polyline must have at least two points, and consecutive
/// points must differ. The curve of a corner may cover half of each adjacent leg, or all of an
/// adjacent first or last leg. On the first leg, the curve of a corner begins only after the
/// distance that a rolling car needs to slow down. The planned speed in each corner is as high as
/// the lengths of the legs allow. If the car's footprint on the rounded path is too near to a box,
/// the function lowers the speed in the nearest corner. At a lower speed, the curve stays closer to
/// the corner. In a corner at a waypoint, the speed is so low that the curve stays within `max_gap`
/// of the corner; if no speed is low enough, the status is kWaypointMissed. Guarantees for the
/// status kOk: the path starts at the polyline's first point along the first leg, and ends at the
/// polyline's last point. The curvature of the rounded path is continuous and at most
/// `max_curvature`. At the capped speeds of the corners, the steering rate is within the car's
/// limit. On the rounded path, the car's footprint is clear of all boxes (CollisionChecker). If the
/// status is not kOk, the reason names the corner or the place of the collision.
RoundedCorners RoundCorners(const VehicleParams& vehicle, const std::vector<Vec2>& polyline,
                            const CornerLimits& limits, const CollisionChecker& clear);

/// Removes points at which the polyline continues straight.
std::vector<Vec2> WithoutCollinearPoints(const std::vector<Vec2>& polyline);

/// Shortens a polyline greedily from its start. Removes points at which the polyline continues
/// straight. Replaces a part of the polyline by a straight segment if this segment keeps more than
/// `inflation` from the boxes.
std::vector<Vec2> Shortcut(const std::vector<Vec2>& polyline, const std::vector<OrientedBox>& boxes,
                           const Inflation& inflation);

}  // namespace trackbed
