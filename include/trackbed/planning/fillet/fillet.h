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

/// Plans paths in which straight legs join the waypoints, and arcs round the corners (Skackauskas,
/// dissertation, eqs. (C.1)-(C.19); the fillet path of Beard and McLain 2012). The planner `fillet`
/// also computes the distances at which a car with rate-limited steering has to start turning its
/// wheels (listing F.1 of the dissertation).
///
/// Symbols, for the turn at waypoint w between the legs q_in and q_out (unit vectors):
///   Angle phi: interior angle between the legs [rad]; pi for straight on, 0 for a U-turn.
///   Angle h: heading change [rad], pi - phi, signed, positive to the left.
///   Radius r: radius of the rear axle's arc [m].
///   Length K: tangent length r/tan(phi/2) [m], from the waypoint to each arc end, eq. (C.11).
///   Length q_S: length of the shorter one of the two legs [m].
///   Angle d_0: neutral steering [rad], the wheels' angle between turns.
///   Angle delta: steering angle on the arc [rad], sgn(h) atan(L/r) with the wheelbase L.
///   Length S_delta: distance that the car rolls while its wheels turn from d_0 to delta [m],
///     v |delta - d_0|/omega_delta.
///   Distances D_{2k-1} and D_2k: driven distances at which the wheels begin to turn into and out
///     of turn k [m].
///   Distance D_end: driven distance at which the car stops [m].
namespace trackbed {

/// The constraint on the radius of each turn.
enum class RadiusConstraint {
  /// The tangent length K of an arc must be at most half of the shorter leg q_S minus the length
  /// S_delta of the steering ramp: K <= q_S/2 - S_delta, eq. (C.40). On each half leg, the arc
  /// leaves enough distance for the wheels to turn.
  kSteeringRoom,
  /// The tangent length K of an arc must be at most half of the shorter leg, K <= q_S/2 (eq.
  /// (C.34)), so that turns do not overlap.
  kHalfLeg,
  /// Arcs with given radii must fit on their legs, without any further constraint.
  kNone,
};

/// Policy for a turn in which no radius leaves room for the steering ramps (eq. (C.40)) at the
/// mission's speed.
enum class InfeasibleTurnPolicy {
  /// Drive the turn as fast as the room for its steering ramps allows (eq. (C.40)), but not more
  /// slowly than `min_speed`. If half the steering ramp at `min_speed` plus the arc's tangent
  /// length exceeds half the leg, reject the plan.
  kSlowDown,
  /// Only require that turns do not overlap (eq. (C.34)), so that the wheels may turn while the car
  /// is on the arcs of the neighboring turns.
  kHalfLeg,
  kRefuse,  ///< Reject the plan.
};

/// The criterion by which the radii of turns are chosen.
enum class RadiusObjective {
  /// Chooses the largest radius that meets the turn's constraint. The largest radius has a closed
  /// form and needs no search.
  kLargest,
  /// Chooses radii by the two passes of listing F.1 (Skackauskas, dissertation). The first pass
  /// simulates a run with the smallest radii. For each turn, the first pass yields the time t and
  /// the heading change dpsi of an interval of the run. The interval of a turn begins when the
  /// wheels turn back at the end of the previous turn. The interval of a turn ends when the wheels
  /// turn back at the end of the turn itself. The second pass is a search that minimizes (psi'(r) t
  /// - dpsi)^2, with the yaw rate psi'(r) on the radius r and the interval's duration t and heading
  /// change dpsi. Because the interval of the first turn includes the straight before it, the first
  /// turn's optimal radius is always at a bound.
  kLiteral,
  /// Same as kLiteral, but the time t and the heading change dpsi cover only the turn itself, from
  /// the start of steering in (D_{2k-1}) to the start of steering back (D_2k). With kTurnLocal, the
  /// chosen radius is the radius that the rate-limited car actually drove in the first run.
  kTurnLocal,
  /// Optimizes all radii, the driven distances at which the wheels begin to turn (D_{2k-1}, D_2k)
  /// and the stop D_end together (the complete eq. (C.20)). The objective J (DrivenWeights)
  /// penalizes the distance between the simulated car and the planned point at the same driven
  /// distance, and the car's final distance from the goal.
  kDriven,
};

/// Weights of the objective of kDriven, J = position int(e_x^2 + e_y^2) ds + heading int(e_psi^2)
/// ds + end |e(D_end)|^2, with the errors e_x and e_y of the position and e_psi of the heading.
struct DrivenWeights {
  double position = 1.0;  ///< Weight w_xy of the position error [1/m^3], >= 0.
  double heading = 1.0;   ///< Weight w_psi of the heading error [1/m], >= 0.
  double end = 100.0;     ///< Weight w_end of the distance from the goal [1/m^2], >= 0.
};
void Visit(KeyVisitor& keys, DrivenWeights& weights);

struct FilletOptions {
  /// Radius of every turn [m]; if nullopt, the objective determines the radii.
  std::optional<double> radius;
  RadiusConstraint constraint = RadiusConstraint::kSteeringRoom;
  /// Neutral angle d_0 of the road wheels [rad], positive to the left. The wheels have the neutral
  /// angle between turns. The steering angle delta on an arc does not depend on the neutral angle
  /// d_0. If d_0 is not 0, a kinematic car leaves the straight legs of the path, because the car
  /// drives on a circle of radius L/tan(d_0) between turns (L: wheelbase).
  double neutral_steering = 0.0;
  /// Upper bound of the radii that the search considers [m]. The default bound of 154 m is taken
  /// from Skackauskas (listing F.1) and corresponds to a steering angle of one degree. Radii above
  /// `max_radius` are only used in turns of less than a degree in which no smaller radius leaves
  /// room for the steering ramps (eq. (C.40)).
  double max_radius = 154.0;
  InfeasibleTurnPolicy without_room = InfeasibleTurnPolicy::kSlowDown;
  double min_speed = 0.5;  ///< Lowest speed of the car in a turn [m/s].
  RadiusObjective objective = RadiusObjective::kLargest;
  SearchOptions search;  ///< Options of the search for radii, for every objective except kLargest.
  /// Whether the objectives kLiteral and kTurnLocal simulate the first run again before they search
  /// for each turn's radius.
  bool resimulate_each_turn = false;
  /// Point of the car that follows the path in the first run and in the verification.
  ReferencePoint reference = ReferencePoint::kRearAxle;
  DrivenWeights weights;  ///< Weights of the objective kDriven.
  /// Largest allowed distance of each arc from its waypoint [m]; infinite: no bound. The planner
  /// `fillet` sets FilletOptions::max_waypoint_miss from PlanRequest::max_waypoint_miss.
  double max_waypoint_miss = std::numeric_limits<double>::infinity();
};
void Visit(KeyVisitor& keys, FilletOptions& options);

/// The constraint or option that determines the radius of a turn.
enum class ActiveConstraint {
  kGiven,  ///< The turn's radius is set by FilletOptions::radius.
  /// No constraint determines the turn's radius, because the objective has an optimum inside the
  /// bounds.
  kNone,
  /// The turn's radius is the smallest possible one, at the car's largest steering angle.
  kMinRadius,
  kMaxRadius,     ///< The turn's radius is limited by FilletOptions::max_radius.
  kHalfLeg,       ///< The turn's radius is limited because turns must not overlap (eq. (C.34)).
  kSteeringRoom,  ///< The turn's radius is limited by the room for the steering ramps (eq. (C.40)).
  kWaypointMiss,  ///< The turn's radius is limited by FilletOptions::max_waypoint_miss.
};

/// Returns the name of a constraint as written in plan.json: "given", "none", ….
const char* ToString(ActiveConstraint constraint);

/// Describes how the search found the radius of one turn.
struct TurnSearch {
  double first_radius = 0.0;  ///< Radius of the turn in the first run [m].
  double time = 0.0;  ///< Duration t of the part of the first run that the objective evaluates [s].
  /// Heading change dpsi of the car over the duration t of the evaluated part, positive to the left
  /// [rad].
  double heading = 0.0;
  /// Radius r* at which the objective is 0 [m]; infinite if the car did not turn in the evaluated
  /// part of the first run.
  double free_radius = 0.0;
  SearchResult result;  ///< Result of the search, whose only variable is the radius r [m].
};

/// A turn of the plan, at one corner of the route.
struct FilletTurn {
  int waypoint = 0;             ///< Index of the turn's waypoint in the route.
  double heading_change = 0.0;  ///< Heading change h of the turn [rad], positive to the left.
  double interior_angle = 0.0;  ///< Interior angle phi between the legs [rad].
  double shorter_leg = 0.0;     ///< Length q_S of the shorter one of the two legs [m].
  double radius = 0.0;          ///< Radius r of the arc [m].
  double speed = 0.0;           ///< Speed v of the car in the turn [m/s].
  ActiveConstraint active = ActiveConstraint::kNone;
  /// Reason why the car drives the turn below the mission's speed, or why the turn has no room for
  /// its steering ramps (eq. (C.40)); else empty.
  std::string note;
  /// Result of the search for this turn's radius, with the objective kLiteral or kTurnLocal.
  std::optional<TurnSearch> search;
  /// Tangent length K, from the waypoint to either end of the arc [m].
  double tangent_length = 0.0;
  Vec2 center{0.0, 0.0};     ///< Center C of the arc [m], eq. (C.19).
  Vec2 arc_start{0.0, 0.0};  ///< Start point H_i of the arc [m], eq. (C.14).
  Vec2 arc_end{0.0, 0.0};    ///< End point H_{i+1} of the arc [m], eq. (C.15).
  double arc_start_s = 0.0;  ///< Station of the arc's start H_i [m].
  double arc_length = 0.0;   ///< Length of the arc, equal to radius r times heading change |h| [m].
  double neutral = 0.0;      ///< Steering angle d_0 before and after the turn [rad].
  double steering = 0.0;     ///< Steering angle delta on the arc, positive to the left [rad].
  /// Duration of the steering ramp from the neutral angle d_0 to delta at the rate omega_delta,
  /// equal to |delta - d_0|/omega_delta [s].
  double ramp_time = 0.0;
  double ramp_distance = 0.0;  ///< Length S_delta of the steering ramp [m].
  /// Driven distance D_{2k-1} at which the wheels begin to turn for the arc [m]; unless optimized,
  /// half a ramp before the arc's start H_i.
  double steer_start = 0.0;
  /// Driven distance D_{2k} at which the wheels begin to turn back [m]; unless optimized, half a
  /// ramp before the arc's end H_{i+1}.
  double steer_return = 0.0;
  /// Whether the wheels turn back before they reach the arc's steering angle `steering`.
  bool ramp_truncated = false;
};

struct FilletPlan {
  PlanStatus status = PlanStatus::kOk;
  /// Index of the waypoint at which planning failed; -1 if planning did not fail at a waypoint.
  int waypoint = -1;
  std::string reason;  ///< Reason why planning failed; empty if ok.
  std::vector<FilletTurn> turns;
  /// Indices of waypoints that the path leaves out, because a turn at these waypoints has no room.
  std::vector<int> left_out;
  Path path;
  SteeringSchedule schedule;
  /// Driven distance D_end at which the car stops [m]; unless optimized, the path's length.
  double stop_distance = 0.0;
  OpenLoopRun verification;  ///< Simulated open-loop run of the final plan.
  /// Result of the search over all turns together, with the objective kDriven.
  std::optional<SearchResult> search;
};

inline constexpr std::size_t kMinFilletWaypoints = 2;

/// Plans a path along a route of N >= 2 waypoints. The car drives at `speed` [m/s], and more slowly
/// in turns that require a lower speed. A waypoint at which the route continues straight is no
/// turn. If a turn has no room on its legs, the path leaves out waypoints, but still passes them
/// within a quarter of the car's width and FilletOptions::max_waypoint_miss. Every turn at a
/// waypoint that is not left out must have room on its legs. The argument `seed` initializes the
/// random numbers of the search.
///
/// Guarantees: the path is continuous in position and heading to 1e-9, starts at the first waypoint
/// along the first leg and ends at the last waypoint. Every radius meets the constraint of its
/// turn: with kLargest, except for rounding errors; with a search, with a tolerance of 1e-9 m on
/// the leg. For a mirrored or moved route, the result is the mirrored or moved plan, within the
/// tolerance of the search. Because the curvature of the path jumps at both ends of each arc, the
/// steering schedule begins to turn the wheels half a ramp earlier. The planner ignores obstacles
/// and heading changes below 1e-9 rad. Computing time with the objective kLargest: tens of
/// microseconds. A search takes about 0.2 us per evaluation and turn, plus NLopt's own time; the
/// search with the objective kDriven takes 20 us per evaluation.
FilletPlan PlanFillets(const VehicleParams& vehicle, const std::vector<Vec2>& waypoints,
                       double speed, const FilletOptions& options, std::uint64_t seed = 0);

}  // namespace trackbed
