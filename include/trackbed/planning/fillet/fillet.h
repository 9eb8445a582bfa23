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
/// arcs (Skackauskas, dissertation, eqs. (C.1)-(C.19); the fillet path of Beard and McLain 2012).
/// The planner also computes the distances at which a car with rate-limited steering has to start
/// turning its wheels (listing F.1).
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
  /// C.40: K <= q_S/2 - S_delta. The legs leave the distance to turn the wheels.
  kSteeringRoom,
  kHalfLeg,  ///< C.34: K <= q_S/2. Turns do not overlap.
  /// The arcs must only fit on their legs; for given radii.
  kNone,
};

/// How to treat a turn for which C.40 has no radius at the mission's speed.
enum class InfeasibleTurnPolicy {
  /// Drive the turn as fast as C.40 allows, but not slower than `min_speed`. Reject the plan if, at
  /// `min_speed`, half the ramp plus the arc's tangent exceeds half the leg.
  kSlowDown,
  /// Use C.34 instead: the wheels turn on the arcs of the neighboring turns.
  kHalfLeg,
  kRefuse,  ///< Reject the plan.
};

/// The criterion by which radii are chosen.
enum class RadiusObjective {
  /// The largest radius that meets the constraint. The largest radius has a closed form and needs
  /// no search.
  kLargest,
  /// The two passes of listing F.1 (Skackauskas, dissertation). A first run on the smallest radii
  /// gives the time t and the heading change dpsi from the return of one turn to the return of the
  /// next. The search then minimizes (psi'(r) t - dpsi)^2. The time t includes the straight before
  /// the turn, so that the optimum of a first turn always lies on the constraint.
  kLiteral,
  /// As kLiteral, but only over the turn, from D_{2k-1} to D_2k. The result is the radius that the
  /// rate-limited car actually drove.
  kTurnLocal,
  /// Optimizes radii, D_{2k-1}, D_2k and D_end together (C.20 in full). The simulated car then
  /// stays on the planned path at equal arc length, and ends at the goal.
  kDriven,
};

/// Weights of J = position int(e_x^2 + e_y^2) ds + heading int(e_psi^2) ds + end |e(D_end)|^2.
struct DrivenWeights {
  double position = 1.0;  ///< Weight w_xy [1/m^3], >= 0.
  double heading = 1.0;   ///< Weight w_psi [1/m], >= 0.
  double end = 100.0;     ///< Weight w_end [1/m^2], >= 0.
};
void Visit(KeyVisitor& keys, DrivenWeights& weights);

struct FilletOptions {
  /// Radius of every turn [m]. Nullopt: the objective determines the radii.
  std::optional<double> radius;
  RadiusConstraint constraint = RadiusConstraint::kSteeringRoom;
  /// Neutral angle d_0 of the road wheels [rad], positive to the left. The wheels leave this angle
  /// at the start of a turn and return to it at the end. The arc's angle delta does not change.
  /// Unless d_0 is 0, a kinematic car leaves its straight legs on a circle of radius L/tan(d_0).
  double neutral_steering = 0.0;
  /// Upper bound of the search [m]. The default is that of listing F.1, one degree of steering.
  double max_radius = 154.0;
  InfeasibleTurnPolicy without_room = InfeasibleTurnPolicy::kSlowDown;
  double min_speed = 0.5;  ///< Lowest speed in a turn [m/s].
  RadiusObjective objective = RadiusObjective::kLargest;
  SearchOptions search;  ///< Search for every objective except kLargest.
  /// Whether kLiteral and kTurnLocal repeat the first run before every turn.
  bool resimulate_each_turn = false;
  /// The point of the car that follows the path in first runs and verification.
  ReferencePoint reference = ReferencePoint::kRearAxle;
  DrivenWeights weights;  ///< Weights of kDriven.
};
void Visit(KeyVisitor& keys, FilletOptions& options);

/// The constraint or option that determines a radius.
enum class ActiveConstraint {
  kGiven,         ///< The given FilletOptions::radius.
  kNone,          ///< None: the objective has an interior optimum.
  kMinRadius,     ///< The car's full lock.
  kMaxRadius,     ///< The bound FilletOptions::max_radius.
  kHalfLeg,       ///< The constraint C.34.
  kSteeringRoom,  ///< The constraint C.40.
};

/// The spelling of a constraint in plan.json: "given", "none", ….
const char* ToString(ActiveConstraint constraint);

/// How the radius of one turn was found.
struct TurnSearch {
  double first_radius = 0.0;  ///< Radius of the first run [m].
  double time = 0.0;          ///< Duration t of the window of the first run [s].
  double heading = 0.0;       ///< Heading change dpsi in that window [rad], signed.
  /// Zero r* of the objective [m]; infinite for a car that did not turn in the window.
  double free_radius = 0.0;
  SearchResult result;  ///< Result of the search, with x = {r [m]}.
};

/// One corner of the route.
struct FilletTurn {
  int waypoint = 0;             ///< Index of the waypoint in the route.
  double heading_change = 0.0;  ///< Heading change h [rad].
  double interior_angle = 0.0;  ///< Interior angle phi [rad].
  double shorter_leg = 0.0;     ///< Shorter leg q_S [m].
  double radius = 0.0;          ///< Radius r [m].
  double speed = 0.0;           ///< Speed v in the turn [m/s].
  ActiveConstraint active = ActiveConstraint::kNone;
  /// Why the turn is slower than the mission or not under C.40; else empty.
  std::string note;
  std::optional<TurnSearch> search;  ///< Search of kLiteral and kTurnLocal.
  double tangent_length = 0.0;       ///< Tangent length K [m].
  Vec2 center{0.0, 0.0};             ///< Center C of the arc (C.19).
  Vec2 arc_start{0.0, 0.0};          ///< Start H_i of the arc (C.14).
  Vec2 arc_end{0.0, 0.0};            ///< End H_{i+1} of the arc (C.15).
  double arc_start_s = 0.0;          ///< Station of H_i [m].
  double arc_length = 0.0;           ///< Length r |h| of the arc [m].
  double neutral = 0.0;              ///< Wheel angle d_0 before and after the turn [rad].
  double steering = 0.0;             ///< Signed steering delta of the arc [rad].
  double ramp_time = 0.0;            ///< Duration |delta - d_0|/omega_delta of the ramp [s].
  double ramp_distance = 0.0;        ///< Length S_delta of the ramp [m].
  /// Distance D_{2k-1}: half a ramp before H_i unless optimized [m].
  double steer_start = 0.0;
  /// Distance D_{2k}: half a ramp before H_{i+1} unless optimized [m].
  double steer_return = 0.0;
  bool ramp_truncated = false;  ///< Whether the wheels turn back before they reach `steering`.
};

struct FilletPlan {
  PlanStatus status = PlanStatus::kOk;
  int waypoint = -1;   ///< Waypoint of the failure, as an index into the route.
  std::string reason;  ///< Reason of a failure; empty if ok.
  std::vector<FilletTurn> turns;
  Path path;
  SteeringSchedule schedule;
  double stop_distance = 0.0;          ///< Distance D_end [m]; the path's length unless optimized.
  OpenLoopRun verification;            ///< Run of the final plan.
  std::optional<SearchResult> search;  ///< Search of kDriven.
};

/// A closed interval of radii [m].
struct RadiusInterval {
  double low = 0.0;
  double high = 0.0;
};

/// The radii in [r_min, r_max] that meet C.40, or nullopt. C.40 is g(r) = r/tan(phi/2) +
/// v/omega_delta |atan(L/r) - n| - q_S/2 <= 0. The argument `neutral` is n = sgn(h) d_0 [rad],
/// positive toward the turn. The function g decreases and then increases, so that the radii form
/// one interval. The ends of the interval are accurate to the last few bits.
std::optional<RadiusInterval> SteeringRoomRadii(const VehicleParams& vehicle, double speed,
                                                double interior_angle, double shorter_leg,
                                                RadiusInterval bounds, double neutral = 0.0);

/// A closed interval of speeds [m/s].
struct SpeedInterval {
  double low = 0.0;
  double high = 0.0;
};

/// The highest of `speeds` at which C.40 allows a radius within `bounds`; nullopt if there is none.
std::optional<double> SteeringRoomSpeed(const VehicleParams& vehicle, double interior_angle,
                                        double shorter_leg, RadiusInterval bounds,
                                        SpeedInterval speeds, double neutral = 0.0);

/// The radii in `bounds` with r/tan(phi/2) <= q_S/2 (C.34); nullopt if there is none.
std::optional<RadiusInterval> HalfLegRadii(double interior_angle, double shorter_leg,
                                           RadiusInterval bounds);

inline constexpr std::size_t kMinFilletWaypoints = 3;

/// Plans a route of N >= 3 waypoints for a car that keeps `speed`, except in turns that are slowed
/// down. Collinear waypoints make no turn. `seed` initializes the search's random numbers.
///
/// Guarantees: the path is continuous in position and heading to 1e-9, starts at the first waypoint
/// along the first leg and ends at the last waypoint. Every radius meets the constraint of its
/// turn, to rounding (kLargest) or to 1e-9 m of the leg (with a search). A mirrored or moved route
/// gives the mirrored or moved plan, to the tolerance of the search, if any. The steering is not
/// continuous: the curvature jumps at tangent points, so that the schedule starts half a ramp
/// early. Obstacles, and heading changes below 1e-9 rad, are ignored. Cost: tens of microseconds
/// for kLargest. A search costs about 0.2 us per evaluation and turn, plus NLopt's own time;
/// kDriven costs 20 us per evaluation.
FilletPlan PlanFillets(const VehicleParams& vehicle, const std::vector<Vec2>& waypoints,
                       double speed, const FilletOptions& options, std::uint64_t seed = 0);

/// Diagnostics of a turn of a plan, stored in PlanDiagnostics::turns.
struct FilletTurnFindings {
  FilletTurn turn;
  std::string search_method;           ///< Method of `turn.search`, if any.
  std::optional<TurnError> predicted;  ///< Open-loop error of an isolated turn.
};
void Visit(DiagnosticsVisitor& out, const FilletTurnFindings& own);
/// Shifts a turn that lies beyond a replaced stretch of the path, and marks a turn within the
/// stretch.
void ReplaceStretch(FilletTurnFindings& own, const Stations& replaced, double shift);

/// Diagnostics of a plan or of its failure, stored in PlanDiagnostics::planner.
struct FilletDiagnostics {
  std::optional<int> failed_waypoint;    ///< Waypoint at which planning failed.
  double neutral_steering = 0.0;         ///< Neutral steering d_0 [rad].
  double neutral_curvature = 0.0;        ///< Curvature of a kinematic car that steers d_0 [rad/m].
  std::string search_method;             ///< Method of `search`, if any.
  std::optional<SearchResult> search{};  ///< Search over all turns together (kDriven).
};
void Visit(DiagnosticsVisitor& out, const FilletDiagnostics& own);

/// The radii [m] in the variable x of a search over all turns together, from `search` or its
/// history.
std::vector<double> DrivenRadii(const std::vector<double>& x);

/// The planner `fillet`.
PlannerEntry FilletPlanner();

}  // namespace trackbed
