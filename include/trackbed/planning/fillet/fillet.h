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

/// The geometry of the global planner: straight legs join the waypoints, and arcs round the corners
/// (Skackauskas, dissertation, eqs. (C.1)-(C.19); the fillet path of Beard and McLain 2012). The
/// planner also computes the distances at which a car with rate-limited steering has to start
/// turning its wheels (listing F.1).
///
/// Symbols, for the turn at waypoint w between the legs q_in and q_out (unit vectors):
///   phi  interior angle between the legs [rad]: pi for straight on, 0 for a U-turn
///   h    heading change [rad], pi - phi, signed: positive to the left
///   r    radius of the rear axle's arc [m]
///   K    tangent length r/tan(phi/2) [m], from the waypoint to either end of the arc, eq. (C.11)
///   q_S  the shorter one of the two legs [m]
///   d_0  neutral steering: the wheels' angle between turns [rad]
///   delta  steering angle on the arc [rad], sgn(h) atan(L/r)
///   S_delta  distance that the car rolls while its wheels turn from d_0 to delta [m],
///            v |delta - d_0|/omega_delta
///   D_{2k-1}, D_2k  distances at which the wheels begin to turn into and out of turn k [m]
///   D_end  distance at which the car stops [m]
namespace trackbed {

/// The constraint on the radius of a turn.
enum class RadiusConstraint {
  /// Eq. (C.40): K <= q_S/2 - S_delta. The arc leaves enough of each half leg for the wheels to
  /// turn.
  kSteeringRoom,
  kHalfLeg,  ///< Eq. (C.34): K <= q_S/2. Turns do not overlap.
  /// Arcs with given radii must only fit on their legs.
  kNone,
};

/// How to treat a turn for which no radius meets eq. (C.40) at the mission's speed.
enum class InfeasibleTurnPolicy {
  /// Drive the turn as fast as eq. (C.40) allows, but not more slowly than `min_speed`. Reject the
  /// plan if, at `min_speed`, half the ramp plus the arc's tangent exceeds half the leg.
  kSlowDown,
  /// Apply eq. (C.34) instead: the wheels may turn on the arcs of the neighboring turns.
  kHalfLeg,
  kRefuse,  ///< Reject the plan.
};

/// The criterion by which radii are chosen.
enum class RadiusObjective {
  /// The largest radius that meets the constraint. The largest radius has a closed form and needs
  /// no search.
  kLargest,
  /// Chooses radii by the two passes of listing F.1 (Skackauskas, dissertation). A first run on the
  /// smallest radii gives the time t and the heading change dpsi from the moment at which the
  /// wheels turn back from one turn to the same moment of the next turn. The search then minimizes
  /// (psi'(r) t - dpsi)^2, where psi'(r) is the yaw rate on the radius r. The time t includes the
  /// straight before the turn, so that the optimum for the first turn always lies on the
  /// constraint.
  kLiteral,
  /// Same as kLiteral, but t and dpsi cover only the turn, from D_{2k-1} to D_2k. The result is the
  /// radius that the rate-limited car actually drove.
  kTurnLocal,
  /// Optimizes all radii and the distances D_{2k-1}, D_2k and D_end together (all of eq. (C.20)).
  /// The objective J (DrivenWeights) keeps the simulated car near the planned point of equal arc
  /// length, and near the goal at the end.
  kDriven,
};

/// Weights of the objective J of kDriven: J = position int(e_x^2 + e_y^2) ds + heading int(e_psi^2)
/// ds + end |e(D_end)|^2.
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
  /// at the start of a turn and return to this angle at the end. The steering angle delta on the
  /// arc does not depend on d_0. Unless d_0 is 0, a kinematic car drifts off its straight legs, on
  /// a circle of radius L/tan(d_0).
  double neutral_steering = 0.0;
  /// Upper bound of the radius in the search [m]. The default is from listing F.1 and corresponds
  /// to a steering angle of one degree.
  double max_radius = 154.0;
  InfeasibleTurnPolicy without_room = InfeasibleTurnPolicy::kSlowDown;
  double min_speed = 0.5;  ///< Lowest speed in a turn [m/s].
  RadiusObjective objective = RadiusObjective::kLargest;
  SearchOptions search;  ///< Options of the search, for every objective except kLargest.
  /// Whether kLiteral and kTurnLocal repeat the first run before every turn.
  bool resimulate_each_turn = false;
  /// The point of the car that follows the path in the first run and in the verification.
  ReferencePoint reference = ReferencePoint::kRearAxle;
  DrivenWeights weights;  ///< Weights of kDriven.
};
void Visit(KeyVisitor& keys, FilletOptions& options);

/// The constraint or option that determines a radius.
enum class ActiveConstraint {
  kGiven,         ///< The given FilletOptions::radius.
  kNone,          ///< No constraint: the objective has an optimum inside the bounds.
  kMinRadius,     ///< The smallest radius, at the car's full lock.
  kMaxRadius,     ///< The bound FilletOptions::max_radius.
  kHalfLeg,       ///< The constraint of eq. (C.34).
  kSteeringRoom,  ///< The constraint of eq. (C.40).
};

/// Returns the spelling of a constraint in plan.json: "given", "none", ….
const char* ToString(ActiveConstraint constraint);

/// How the radius of one turn was found.
struct TurnSearch {
  double first_radius = 0.0;  ///< Radius of the first run [m].
  double time = 0.0;          ///< Duration t of the evaluated part of the first run [s].
  double heading = 0.0;       ///< Signed heading change dpsi over the duration t [rad].
  /// Radius r* at which the objective is 0 [m]; infinite if the car did not turn over the duration
  /// t.
  double free_radius = 0.0;
  SearchResult result;  ///< Result of the search, with x = {r [m]}.
};

/// One corner of the route.
struct FilletTurn {
  int waypoint = 0;             ///< Index of the waypoint in the route.
  double heading_change = 0.0;  ///< Heading change h [rad].
  double interior_angle = 0.0;  ///< Interior angle phi [rad].
  double shorter_leg = 0.0;     ///< Length q_S of the shorter leg [m].
  double radius = 0.0;          ///< Radius r [m].
  double speed = 0.0;           ///< Speed v in the turn [m/s].
  ActiveConstraint active = ActiveConstraint::kNone;
  /// Reason why the turn is slower than the mission's speed, or does not meet eq. (C.40); else
  /// empty.
  std::string note;
  std::optional<TurnSearch> search;  ///< Result of the search of kLiteral or kTurnLocal.
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
  /// Distance D_{2k-1} at which the wheels begin to turn into the turn [m]; half a ramp before H_i
  /// unless optimized.
  double steer_start = 0.0;
  /// Distance D_{2k} at which the wheels begin to turn back [m]; half a ramp before H_{i+1} unless
  /// optimized.
  double steer_return = 0.0;
  bool ramp_truncated = false;  ///< Whether the wheels turn back before they reach `steering`.
};

struct FilletPlan {
  PlanStatus status = PlanStatus::kOk;
  int waypoint = -1;   ///< Index of the waypoint at which planning failed; -1: none.
  std::string reason;  ///< Reason of a failure; empty if ok.
  std::vector<FilletTurn> turns;
  Path path;
  SteeringSchedule schedule;
  double stop_distance = 0.0;          ///< Distance D_end [m]; the path's length unless optimized.
  OpenLoopRun verification;            ///< Simulated run of the final plan.
  std::optional<SearchResult> search;  ///< Result of the search of kDriven.
};

/// A closed interval of radii [m].
struct RadiusInterval {
  double low = 0.0;
  double high = 0.0;
};

/// Returns the radii within `bounds` that meet eq. (C.40); nullopt if there are none. Eq. (C.40) is
/// g(r) = r/tan(phi/2) + v/omega_delta |atan(L/r) - n| - q_S/2 <= 0. The argument `neutral` is n =
/// sgn(h) d_0 [rad], positive toward the turn. The function g decreases and then increases, so that
/// the returned radii form one interval. The ends of the interval are accurate to the last few
/// bits.
std::optional<RadiusInterval> SteeringRoomRadii(const VehicleParams& vehicle, double speed,
                                                double interior_angle, double shorter_leg,
                                                RadiusInterval bounds, double neutral = 0.0);

/// A closed interval of speeds [m/s].
struct SpeedInterval {
  double low = 0.0;
  double high = 0.0;
};

/// Returns the highest of `speeds` at which eq. (C.40) allows a radius within `bounds`; nullopt if
/// there is no such speed.
std::optional<double> SteeringRoomSpeed(const VehicleParams& vehicle, double interior_angle,
                                        double shorter_leg, RadiusInterval bounds,
                                        SpeedInterval speeds, double neutral = 0.0);

/// Returns the radii within `bounds` that meet eq. (C.34), r/tan(phi/2) <= q_S/2; nullopt if there
/// are none.
std::optional<RadiusInterval> HalfLegRadii(double interior_angle, double shorter_leg,
                                           RadiusInterval bounds);

inline constexpr std::size_t kMinFilletWaypoints = 3;

/// Plans a path along a route of N >= 3 waypoints. The car drives at `speed` [m/s], and more slowly
/// in turns that require a lower speed. Collinear waypoints make no turn. `seed` initializes the
/// random numbers of the search.
///
/// Guarantees: the path is continuous in position and heading to 1e-9, starts at the first waypoint
/// along the first leg and ends at the last waypoint. Every radius meets the constraint of its
/// turn: with kLargest, to rounding; with a search, to 1e-9 m of the leg. A mirrored or moved route
/// gives the mirrored or moved plan, to the tolerance of the search, if any. The curvature of the
/// path jumps at tangent points. The steering schedule therefore begins each turn half a ramp
/// before the arc. Obstacles, and heading changes below 1e-9 rad, are ignored. Cost: tens of
/// microseconds for kLargest. A search costs about 0.2 us per evaluation and turn, plus NLopt's own
/// time; kDriven costs 20 us per evaluation.
FilletPlan PlanFillets(const VehicleParams& vehicle, const std::vector<Vec2>& waypoints,
                       double speed, const FilletOptions& options, std::uint64_t seed = 0);

/// Diagnostics of a turn of a plan, stored in PlanDiagnostics::turns.
struct FilletTurnFindings {
  FilletTurn turn;
  std::string search_method;           ///< Name of the method of `turn.search`, if any.
  std::optional<TurnError> predicted;  ///< Open-loop error of an isolated turn.
};
void Visit(DiagnosticsVisitor& out, const FilletTurnFindings& own);
/// Shifts the stations of a turn beyond a replaced stretch of the path. Adds a note to a turn that
/// overlaps the stretch.
void ReplaceStretch(FilletTurnFindings& own, const Stations& replaced, double shift);

/// Diagnostics of a plan or of its failure, stored in PlanDiagnostics::planner.
struct FilletDiagnostics {
  std::optional<int> failed_waypoint;  ///< Waypoint at which planning failed.
  double neutral_steering = 0.0;       ///< Neutral steering d_0 [rad].
  /// Curvature that a kinematic car drives with the steering angle d_0 [rad/m].
  double neutral_curvature = 0.0;
  std::string search_method;  ///< Name of the method of `search`, if any.
  /// Result of the search over all turns together (kDriven).
  std::optional<SearchResult> search{};
};
void Visit(DiagnosticsVisitor& out, const FilletDiagnostics& own);

/// Extracts the radii [m] from the variables x of a search over all turns together. `x` is a result
/// of the search, or an entry of its history.
std::vector<double> DrivenRadii(const std::vector<double>& x);

/// Returns the planner `fillet`.
PlannerEntry FilletPlanner();

}  // namespace trackbed
