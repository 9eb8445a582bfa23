#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/planning/plan_status.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

/// The global planner's geometry: waypoints joined by straight legs whose corners are rounded by
/// arcs (dissertation appendix C, equations C.1-C.19; Beard & McLain's fillet path), and the
/// distances at which a car with rate-limited steering has to start turning its wheels (F.1).
///
/// Symbols, for the turn at waypoint w between the legs q_in and q_out (unit vectors):
///   phi  interior angle between the legs [rad]: pi for straight on, 0 for a U-turn
///   h    heading change [rad], pi - phi, signed: positive to the left
///   r    radius of the rear axle's arc [m]
///   K    tangent length r/tan(phi/2) [m], from the waypoint to either end of the arc (C.11)
///   q_S  the shorter one of the two legs [m]
///   S_delta = v atan(L/r)/omega_delta: rolled while the wheels turn to the arc's angle [m]
namespace trackbed {

/// What a radius has to satisfy.
enum class RadiusConstraint {
  kSteeringRoom,  ///< C.40: K <= q_S/2 - S_delta; the turn leaves the distance to turn the wheels
  kHalfLeg,       ///< C.34: K <= q_S/2; turns do not overlap
  kNone,          ///< only that the arcs fit on their legs; for given radii
};

struct FilletOptions {
  /// [m], for every turn; none: the largest one that satisfies the constraint.
  std::optional<double> radius;
  RadiusConstraint constraint = RadiusConstraint::kSteeringRoom;
  double max_radius = 154.0;  ///< upper bound of the search [m]; the seed's, one degree of steering
};

/// One corner of the route.
struct FilletTurn {
  int waypoint = 0;             ///< its index in the route
  double heading_change = 0.0;  ///< h [rad]
  double interior_angle = 0.0;  ///< phi [rad]
  double radius = 0.0;          ///< r [m]
  double tangent_length = 0.0;  ///< K [m]
  Vec2 centre{0.0, 0.0};        ///< C (C.19)
  Vec2 arc_start{0.0, 0.0};     ///< H_i (C.14)
  Vec2 arc_end{0.0, 0.0};       ///< H_{i+1} (C.15)
  double arc_start_s = 0.0;     ///< station of H_i [m]
  double arc_length = 0.0;      ///< r |h| [m]
  double steering = 0.0;        ///< signed delta of the arc [rad]
  double ramp_time = 0.0;       ///< |delta|/omega_delta [s]
  double ramp_distance = 0.0;   ///< S_delta [m]
  double steer_start = 0.0;     ///< D_{2k-1}: the wheels start to turn, half a ramp before H_i [m]
  double steer_return = 0.0;    ///< D_{2k}: they start to return, half a ramp before H_{i+1} [m]
  bool ramp_truncated = false;  ///< the arc is shorter than the ramp: the wheels never get there
};

struct FilletPlan {
  PlanStatus status = PlanStatus::kOk;
  int waypoint = -1;   ///< where it failed: index into the route
  std::string reason;  ///< for people; empty when ok
  std::vector<FilletTurn> turns;
  Path path;
  SteeringSchedule schedule;
};

/// A closed interval of radii [m].
struct RadiusInterval {
  double low = 0.0;
  double high = 0.0;
};

/// Radii in [r_min, r_max] with g(r) = r/tan(phi/2) + v/omega_delta atan(L/r) - q_S/2 <= 0 (C.40),
/// or none. g is convex, so they are one interval; its ends are found to the last few bits.
std::optional<RadiusInterval> SteeringRoomRadii(const VehicleParams& vehicle, double speed,
                                                double interior_angle, double shorter_leg,
                                                RadiusInterval bounds);

/// Radii in `bounds` with r/tan(phi/2) <= q_S/2 (C.34), or none.
std::optional<RadiusInterval> HalfLegRadii(double interior_angle, double shorter_leg,
                                           RadiusInterval bounds);

/// Plans a route of N >= 3 waypoints (collinear ones make no turn) for a car that keeps `speed`.
///
/// Guarantees: the path is continuous in position and heading to 1e-9, starts at the first waypoint
/// along the first leg and ends at the last one; every turn satisfies the constraint to rounding;
/// each radius is the largest that does unless given. A mirrored or moved route gives the mirrored
/// or moved plan. Does not make the steering continuous: at tangent points the curvature jumps,
/// which is why the schedule starts half a ramp early. Does not look at obstacles. Cost:
/// microseconds. Heading changes below 1e-9 rad count as none.
FilletPlan PlanFillets(const VehicleParams& vehicle, const std::vector<Vec2>& waypoints,
                       double speed, const FilletOptions& options);

}  // namespace trackbed
