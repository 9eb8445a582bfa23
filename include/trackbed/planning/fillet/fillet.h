#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/optimize/search.h"
#include "trackbed/path/path.h"
#include "trackbed/planning/common/open_loop.h"
#include "trackbed/planning/common/plan_status.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/common/turn_prediction.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

/// The global planner's geometry: waypoints joined by straight legs whose corners are rounded by
/// arcs (Skackauskas, dissertation, eqs. (C.1)-(C.19); the fillet path of Beard and McLain 2012),
/// and the distances at which a car with rate-limited steering has to start turning its wheels
/// (listing F.1).
///
/// Symbols, for the turn at waypoint w between the legs q_in and q_out (unit vectors):
///   phi  interior angle between the legs [rad]: pi for straight on, 0 for a U-turn
///   h    heading change [rad], pi - phi, signed: positive to the left
///   r    radius of the rear axle's arc [m]
///   K    tangent length r/tan(phi/2) [m], from the waypoint to either end of the arc (C.11)
///   q_S  the shorter one of the two legs [m]
///     d_0  neutral steering: the wheels' angle between turns [rad]
///   S_delta = v |delta - d_0|/omega_delta: distance rolled while the wheels turn to the arc's
///   angle,
///        delta = sgn(h) atan(L/r) [m]
///   D_{2k-1}, D_2k  distances at which the wheels start into and out of turn k [m]
///   D_end  distance at which the car stops [m]
namespace trackbed {

/// The constraint on a radius.
enum class RadiusConstraint {
  kSteeringRoom,  ///< C.40: K <= q_S/2 - S_delta; the turn leaves the distance to turn the wheels
  kHalfLeg,       ///< C.34: K <= q_S/2; turns do not overlap
  kNone,          ///< only that the arcs fit on their legs; for given radii
};

/// How to treat a turn for which C.40 has no radius at the mission's speed.
enum class InfeasibleTurnPolicy {
  /// Take it as fast as C.40 allows. If that is below `min_speed`, take it at `min_speed`, provided
  /// that the part of the ramp on the leg, which is half of it, fits into half the leg beside the
  /// arc's tangent; otherwise reject the plan.
  kSlowDown,
  kHalfLeg,  ///< take it under C.34: the wheels turn on the arcs of the neighboring turns
  kRefuse,   ///< no plan
};

/// The criterion by which radii are chosen.
enum class RadiusObjective {
  /// The largest radius that meets the constraint. Closed form; no search.
  kLargest,
  /// The two passes of Skackauskas, dissertation, listing F.1: a first run on the smallest radii
  /// gives the time t and the heading change dpsi from the return of one turn to the return of the
  /// next; the search minimizes (psi'(r) t - dpsi)^2. That time includes the straight before the
  /// turn, so that the optimum of a first turn always lies on the constraint.
  kLiteral,
  /// As kLiteral, over the turn only, from D_{2k-1} to D_2k: the radius that the rate-limited car
  /// actually drove.
  kTurnLocal,
  /// Optimizes radii, D_{2k-1}, D_2k and D_end together, so that the driven car stays on the
  /// planned path at equal arc length and ends at the goal (C.20 in full).
  kDriven,
};

/// J = position int(e_x^2 + e_y^2) ds + heading int(e_psi^2) ds + end |e(D_end)|^2.
struct DrivenWeights {
  double position = 1.0;  ///< w_xy [1/m^3], >= 0
  double heading = 1.0;   ///< w_psi [1/m], >= 0
  double end = 100.0;     ///< w_end [1/m^2], >= 0
};
void Visit(KeyVisitor& keys, DrivenWeights& weights);

struct FilletOptions {
  /// Radius of every turn [m]; none: chosen by the objective.
  std::optional<double> radius;
  RadiusConstraint constraint = RadiusConstraint::kSteeringRoom;
  /// d_0 [rad], positive to the left: the wheels leave this angle at the start of a turn, and
  /// return to it at its end. It is an angle of the road wheels, as is delta, which remains the
  /// arc's angle. Unless d_0 is 0, a kinematic car leaves its straight legs on a circle of radius
  /// L/tan(d_0).
  double neutral_steering = 0.0;
  double max_radius = 154.0;  ///< upper bound of the search [m]; listing F.1's, one degree
  InfeasibleTurnPolicy without_room = InfeasibleTurnPolicy::kSlowDown;
  double min_speed = 0.5;  ///< lowest speed in a turn [m/s]
  RadiusObjective objective = RadiusObjective::kLargest;
  SearchOptions search;  ///< for every objective except kLargest
  /// kLiteral, kTurnLocal: repeats the first run before every turn.
  bool resimulate_each_turn = false;
  /// The point of the car that follows the path in first runs and verification.
  ReferencePoint reference = ReferencePoint::kRearAxle;
  DrivenWeights weights;  ///< of kDriven
};
void Visit(KeyVisitor& keys, FilletOptions& options);

/// The constraint or option that determines a radius.
enum class ActiveConstraint {
  kGiven,         ///< FilletOptions::radius
  kNone,          ///< the objective alone: an interior optimum
  kMinRadius,     ///< the car's full lock
  kMaxRadius,     ///< FilletOptions::max_radius
  kHalfLeg,       ///< C.34
  kSteeringRoom,  ///< C.40
};

/// "given", "none", …: the spelling of plan.json.
const char* ToString(ActiveConstraint constraint);

/// How the radius of one turn was found.
struct TurnSearch {
  double first_radius = 0.0;  ///< of the first run [m]
  double time = 0.0;          ///< t: duration of the window of the first run [s]
  double heading = 0.0;       ///< dpsi: heading change in that window [rad], signed
  /// r*: zero of the objective [m]; infinite for a car that did not turn in the window.
  double free_radius = 0.0;
  SearchResult result;  ///< x = {r [m]}
};

/// One corner of the route.
struct FilletTurn {
  int waypoint = 0;             ///< its index in the route
  double heading_change = 0.0;  ///< h [rad]
  double interior_angle = 0.0;  ///< phi [rad]
  double shorter_leg = 0.0;     ///< q_S [m]
  double radius = 0.0;          ///< r [m]
  double speed = 0.0;           ///< v at which it is taken [m/s]
  ActiveConstraint active = ActiveConstraint::kNone;
  std::string note;                  ///< why not at the mission's speed or under C.40; else empty
  std::optional<TurnSearch> search;  ///< kLiteral and kTurnLocal
  double tangent_length = 0.0;       ///< K [m]
  Vec2 center{0.0, 0.0};             ///< C (C.19)
  Vec2 arc_start{0.0, 0.0};          ///< H_i (C.14)
  Vec2 arc_end{0.0, 0.0};            ///< H_{i+1} (C.15)
  double arc_start_s = 0.0;          ///< station of H_i [m]
  double arc_length = 0.0;           ///< r |h| [m]
  double neutral = 0.0;              ///< d_0: wheel angle before and after the turn [rad]
  double steering = 0.0;             ///< signed delta of the arc [rad]
  double ramp_time = 0.0;            ///< |delta - d_0|/omega_delta [s]
  double ramp_distance = 0.0;        ///< S_delta [m]
  double steer_start = 0.0;          ///< D_{2k-1}: half a ramp before H_i unless optimized [m]
  double steer_return = 0.0;         ///< D_{2k}: half a ramp before H_{i+1} unless optimized [m]
  bool ramp_truncated = false;       ///< the wheels turn back before they reach `steering`
};

struct FilletPlan {
  PlanStatus status = PlanStatus::kOk;
  int waypoint = -1;   ///< waypoint of the failure: index into the route
  std::string reason;  ///< empty when ok
  std::vector<FilletTurn> turns;
  Path path;
  SteeringSchedule schedule;
  double stop_distance = 0.0;          ///< D_end [m]; the path's length unless optimized
  OpenLoopRun verification;            ///< of the final plan
  std::optional<SearchResult> search;  ///< of kDriven
};

/// A closed interval of radii [m].
struct RadiusInterval {
  double low = 0.0;
  double high = 0.0;
};

/// The radii in [r_min, r_max] with g(r) = r/tan(phi/2) + v/omega_delta |atan(L/r) - n| - q_S/2 <=
/// 0 (C.40), or none; `neutral` is n = sgn(h) d_0 [rad], positive toward the turn. g falls and then
/// rises, so that the radii form one interval; its ends are accurate to the last few bits.
std::optional<RadiusInterval> SteeringRoomRadii(const VehicleParams& vehicle, double speed,
                                                double interior_angle, double shorter_leg,
                                                RadiusInterval bounds, double neutral = 0.0);

/// A closed interval of speeds [m/s].
struct SpeedInterval {
  double low = 0.0;
  double high = 0.0;
};

/// The highest of `speeds` at which C.40 allows a radius within `bounds`, or none.
std::optional<double> SteeringRoomSpeed(const VehicleParams& vehicle, double interior_angle,
                                        double shorter_leg, RadiusInterval bounds,
                                        SpeedInterval speeds, double neutral = 0.0);

/// Radii in `bounds` with r/tan(phi/2) <= q_S/2 (C.34), or none.
std::optional<RadiusInterval> HalfLegRadii(double interior_angle, double shorter_leg,
                                           RadiusInterval bounds);

inline constexpr std::size_t kMinFilletWaypoints = 3;

/// Plans a route of N >= 3 waypoints (collinear ones make no turn) for a car that keeps `speed`,
/// except in turns that are slowed down. `seed` initializes the search's random numbers.
///
/// Guarantees: the path is continuous in position and heading to 1e-9, starts at the first waypoint
/// along the first leg and ends at the last one; every radius meets the constraint stated for its
/// turn, to rounding (kLargest) or to 1e-9 m of the leg (searched). A mirrored or moved route gives
/// the mirrored or moved plan, to the tolerance of its search, if any. The steering is not
/// continuous: the curvature jumps at tangent points, so that the schedule starts half a ramp
/// early. Ignores obstacles. Heading changes below 1e-9 rad are ignored. Cost: tens of microseconds
/// for kLargest; with a search that of its evaluations, about 0.2 us each per turn plus NLopt's,
/// for kDriven some 20 us each.
FilletPlan PlanFillets(const VehicleParams& vehicle, const std::vector<Vec2>& waypoints,
                       double speed, const FilletOptions& options, std::uint64_t seed = 0);

/// Diagnostics of a turn of a plan: PlanDiagnostics::turns.
struct FilletTurnFindings {
  FilletTurn turn;
  std::string search_method;           ///< of `turn.search`, if any
  std::optional<TurnError> predicted;  ///< open-loop error of an isolated turn
};
void Visit(DiagnosticsVisitor& out, const FilletTurnFindings& own);
/// Shifts a turn beyond a replaced stretch of the path, and marks a turn within it.
void ReplaceStretch(FilletTurnFindings& own, const Stations& replaced, double shift);

/// Diagnostics of a plan or of its failure: PlanDiagnostics::planner.
struct FilletDiagnostics {
  std::optional<int> failed_waypoint;    ///< of a plan that failed
  double neutral_steering = 0.0;         ///< d_0 [rad]
  double neutral_curvature = 0.0;        ///< of a kinematic car that steers d_0 [rad/m]
  std::string search_method;             ///< of `search`, if any
  std::optional<SearchResult> search{};  ///< of all turns together (kDriven)
};
void Visit(DiagnosticsVisitor& out, const FilletDiagnostics& own);

/// The radii [m] in x of a search of all turns together, from `search` or its history.
std::vector<double> DrivenRadii(const std::vector<double>& x);

/// The planner `fillet`.
PlannerEntry FilletPlanner();

}  // namespace trackbed
