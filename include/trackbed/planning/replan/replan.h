#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/replan/along_route.h"
#include "trackbed/planning/replan/detour.h"
#include "trackbed/planning/replan/replan_options.h"

/// Replanning during a run, from the obstacles known at that time: motions along the route
/// (along_route.h), a detour if no motion passes the obstacle (detour.h), and braking before the
/// obstacle if there is no detour.
///
/// Plans are driven one after the other. A new plan begins at the planned point beside the car,
/// with the planned curvature, speed and acceleration, so that nothing jumps at the change. If the
/// car has strayed from its plan, the new plan begins with the car's actual pose, steering and
/// speed.
namespace trackbed {

/// The state of a run: its route and current plan.
struct Driving {
  Plan route;                  ///< Plan to the goal.
  RouteFrame frame;            ///< Frame of the route, see MakeRouteFrame.
  Plan plan;                   ///< Current plan: the route, or a motion along it.
  bool on_route = true;        ///< Whether the current plan is the route.
  double station = 0.0;        ///< Station of the car on the plan [m].
  double route_station = 0.0;  ///< Approximate station of the car on the route [m].
};

struct ReplanRequest {
  VehicleParams vehicle;
  SpeedLimits speed;
  Wind wind;
  double time = 0.0;  ///< Present time [s].
  MotionState car;    ///< Actual pose, curvature of the steering, and speed.
  /// Whether the car is far from the plan. The new plan then starts at the car's pose.
  bool strayed = false;
  /// The hardest braking that tyres, brakes and the road ahead allow [m/s^2]. 0: the deceleration
  /// of the speed limits.
  double max_deceleration = 0.0;
  std::vector<MovingBox> obstacles;  ///< Known obstacles at their present positions.
  std::uint64_t seed = 0;
  RoadConditions road{};  ///< Road conditions that limit new plans.
};

enum class ReplanKind {
  kKeep,    ///< Keep the current plan.
  kMotion,  ///< A motion along the route.
  /// Return to the route, or take a detour. The plan is the new route.
  kRoute,
  kStop,  ///< Brake, before the obstacle if possible.
};

/// The name of a kind: "keep", "motion", "route", "stop".
const char* ToString(ReplanKind kind);

/// How a plan was found during the run, stored in PlanDiagnostics::replan.
struct ReplanDiagnostics {
  std::string kind;                  ///< Kind: "motion", "detour", "back_on_route" or "brake".
  std::optional<AlongPlan> along{};  ///< Motion along the route, if a motion was searched.
  std::optional<DetourFindings> detour{};
  std::optional<double> deceleration{};  ///< Deceleration of braking [m/s^2].
};
void Visit(DiagnosticsVisitor& out, const ReplanDiagnostics& own);

struct Replanned {
  ReplanKind kind = ReplanKind::kKeep;
  /// The new plan, whose stations begin beside the car. Plan::blocked states why it ends before the
  /// goal, if it does. PlanDiagnostics::replan has the ReplanDiagnostics. Empty if the old plan is
  /// kept.
  FeasiblePlan plan;
};

/// The first time at which the car, following its plan, comes too close to a known obstacle.
struct PredictedConflict {
  double time = 0.0;     ///< Time from now [s].
  double station = 0.0;  ///< Station on the plan [m].
  std::size_t obstacle = 0;
};

/// Tests the plan every 0.1 s at its planned speeds, from `station` on, for a car that stays
/// `offset` [m] to the left of the plan. Bisects the start of the conflict to 0.1 ms. Nullopt
/// without a conflict within `look_ahead` [s].
std::optional<PredictedConflict> PredictConflict(const VehicleParams& vehicle,
                                                 const Reference& reference, double station,
                                                 const std::vector<MovingBox>& obstacles,
                                                 double distance, double look_ahead,
                                                 double offset = 0.0);

/// Whether an obstacle stands in a turn: the path beyond `station` is curved at a place that is
/// closer to the obstacle than `distance`.
bool StandsInTurn(const VehicleParams& vehicle, const Path& path, double station,
                  const OrientedBox& obstacle, double distance);

/// Whether waiting may help: a moving obstacle is closer than `distance` to the next 30 m of a
/// path, or will be that close within a minute.
bool MightClear(const VehicleParams& vehicle, const Path& path, double station,
                const std::vector<MovingBox>& obstacles, double distance);

/// Keeps a clear plan that is the route or a motion to the goal. Otherwise uses the first available
/// option in this order: the rest of the route, if it is clear and the car is back on the route; a
/// motion that passes the obstacle; a detour that the comparator prefers; a motion that stops or
/// continues for now; the current plan, if it is clear; braking.
///
/// The car brakes before a standing obstacle at the speed limits' deceleration, to stop half a
/// meter before the conflict. If there is no time for that, it brakes at once, at the constant
/// deceleration that this stop requires, at most `max_deceleration`. Before a moving obstacle, it
/// brakes at once, at the smallest deceleration that avoids the obstacle. The deceleration is one
/// of eight steps between the limits' and the hardest deceleration; if none avoids the obstacle, it
/// is the hardest. `max_deceleration` is never exceeded, even if it is less than the comfortable
/// deceleration.
///
/// Every new plan passes MakeFeasible. A route that exceeds the grip of the road is slowed down
/// there; a motion that exceeds the grip is not used. Braking that exceeds the limits at any speed
/// is driven anyway, with a note, because no alternative is left.
///
/// Guarantees: a new plan begins with the planned steering of the old plan beside the car, or with
/// the actual steering if the car has strayed. The look-ahead is at least the time that the car
/// needs to stop from the mission's speed, plus two periods. The same input gives the same bytes.
/// New plans have no reverse segments. Errors: InternalError for options without a method. Cost:
/// that of the evaluated motions and detours.
Replanned Replan(const ReplanRequest& request, const Driving& driving,
                 const ReplanOptions& options);

}  // namespace trackbed
