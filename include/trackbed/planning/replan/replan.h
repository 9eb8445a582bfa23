#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/replan/along_route.h"
#include "trackbed/planning/replan/detour.h"
#include "trackbed/planning/replan/replan_options.h"

/// Replanning during a run, from what is known by then: motions along the route (along_route.h), a
/// detour if no motion passes the obstacle (detour.h), and braking before the obstacle if there is
/// no detour.
///
/// Plans are driven one after the other. A new plan begins at the planned point beside the car,
/// with the curvature, speed and acceleration planned there, so that nothing jumps at the change;
/// if the car has strayed from its plan, it begins with the car's actual pose, steering and speed.
namespace trackbed {

/// The state of a run: its route and current plan.
struct Driving {
  Plan route;                  ///< to the goal
  RouteFrame frame;            ///< of the route; see MakeRouteFrame
  Plan plan;                   ///< current plan: the route or a motion along it
  bool on_route = true;        ///< the plan is the route
  double station = 0.0;        ///< of the car on the plan [m]
  double route_station = 0.0;  ///< approximate, of the car on the route [m]
};

struct ReplanRequest {
  VehicleParams vehicle;
  SpeedLimits speed;
  Wind wind;
  double time = 0.0;     ///< [s]
  MotionState car;       ///< actual pose, curvature of its steering, speed
  bool strayed = false;  ///< the car is far from the plan: start from its pose
  /// The hardest braking that tyres, brakes and the road ahead allow [m/s^2]; 0: the limits'
  /// deceleration.
  double max_deceleration = 0.0;
  std::vector<MovingBox> obstacles;  ///< known obstacles at their present positions
  std::uint64_t seed = 0;
  RoadConditions road{};  ///< that new plans are held to
};

enum class ReplanKind {
  kKeep,    ///< keep the current plan
  kMotion,  ///< a motion along the route
  kRoute,   ///< return to the route, or take a detour: the plan is the new route
  kStop,    ///< brake, before the obstacle if possible
};

/// "keep", "motion", "route", "stop".
const char* ToString(ReplanKind kind);

/// How a plan was found during the run: PlanDiagnostics::replan.
struct ReplanDiagnostics {
  std::string kind;                  ///< "motion", "detour", "back_on_route" or "brake"
  std::optional<AlongPlan> along{};  ///< the motion along the route, if one was searched for
  std::optional<DetourFindings> detour{};
  std::optional<double> deceleration{};  ///< of braking [m/s^2]
};
void Visit(DiagnosticsVisitor& out, const ReplanDiagnostics& own);

struct Replanned {
  ReplanKind kind = ReplanKind::kKeep;
  /// Its stations begin beside the car. Plan::blocked states why it ends before the goal, if it
  /// does; PlanDiagnostics::replan has the ReplanDiagnostics. Empty if the old plan is kept.
  FeasiblePlan plan;
};

/// The first time at which the car, on its plan, comes too close to a known obstacle.
struct PredictedConflict {
  double time = 0.0;     ///< from now [s]
  double station = 0.0;  ///< of the plan [m]
  std::size_t obstacle = 0;
};

/// Tests the plan every 0.1 s at its planned speeds, from `station` on, for a car that stays
/// `offset` [m] to the left of it, and bisects the start of the conflict to 0.1 ms. None without a
/// conflict within `look_ahead` [s].
std::optional<PredictedConflict> PredictConflict(const VehicleParams& vehicle,
                                                 const Reference& reference, double station,
                                                 const std::vector<MovingBox>& obstacles,
                                                 double distance, double look_ahead,
                                                 double offset = 0.0);

/// Whether an obstacle stands in a turn: the path is curved where the obstacle is closer than
/// `distance` to it, from `station` on.
bool StandsInTurn(const VehicleParams& vehicle, const Path& path, double station,
                  const OrientedBox& obstacle, double distance);

/// Whether waiting may help: a moving obstacle is closer than `distance` to the next 30 m of a
/// path, or will be within a minute.
bool MightClear(const VehicleParams& vehicle, const Path& path, double station,
                const std::vector<MovingBox>& obstacles, double distance);

/// Keeps a route or a motion to the goal that is clear. Otherwise takes the first available of: the
/// rest of the route, if the car is back on it and it is clear; a motion that passes the obstacle;
/// a detour that the comparator prefers; a motion that stops or continues for now; the current
/// plan, if it is clear; braking.
///
/// Braking before a standing obstacle: at the speed limits' deceleration, to stop half a meter
/// before the conflict, if there is time; otherwise at once, at the constant deceleration that this
/// requires, at most `max_deceleration`. Braking before a moving obstacle: at once, at the smallest
/// deceleration that stays clear of it, in eighths between the limits' and the hardest; otherwise
/// at the hardest. `max_deceleration` is never exceeded, even if it is less than the comfortable
/// deceleration.
///
/// Every new plan passes MakeFeasible. A route is slowed down where the road holds less, a motion
/// that asks more than the road holds is not taken. Braking that no slower speed brings within the
/// limits is driven anyway, with a note: there is nothing better left.
///
/// Guarantees: the planned steering at the start of a new plan is that of the old one beside the
/// car, or the car's actual steering if it has strayed. Looks ahead at least as long as the car
/// needs to stop from the mission's speed, and two periods. The same input gives the same bytes.
/// Does not plan reverse segments. Errors: InternalError for options without a method. Cost: that
/// of the motions and detours tried.
Replanned Replan(const ReplanRequest& request, const Driving& driving,
                 const ReplanOptions& options);

}  // namespace trackbed
