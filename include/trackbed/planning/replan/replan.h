#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/replan/along_route.h"
#include "trackbed/planning/replan/detour.h"
#include "trackbed/planning/replan/replan_options.h"

/// Replans during a run, from the obstacles known so far: motions along the route (along_route.h),
/// a detour if no motion passes the obstacle (detour.h), and braking before the obstacle if there
/// is no detour.
///
/// The car drives one plan after the other. A new plan begins at the point of the old plan beside
/// the car, with the planned curvature, speed and acceleration, so that these quantities do not
/// jump when the plan changes. If the car has strayed from its plan, the new plan begins with the
/// car's actual pose, steering and speed.
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
  MotionState car;    ///< Actual pose and speed of the car, and the curvature that it steers.
  /// Whether the car is far from the plan, so that the new plan starts at the car's pose.
  bool strayed = false;
  /// The hardest braking that tyres, brakes and the road ahead allow [m/s^2]. With 0, the
  /// deceleration of the speed limits applies.
  double max_deceleration = 0.0;
  std::vector<MovingBox> obstacles;  ///< Known obstacles at their present positions.
  std::uint64_t seed = 0;
  RoadConditions road{};  ///< Road conditions that limit new plans.
};

enum class ReplanKind {
  kKeep,    ///< Keep the current plan.
  kMotion,  ///< A motion along the route.
  /// Return to the route, or take a detour. The new plan is the new route.
  kRoute,
  kStop,  ///< Brake, before the obstacle if possible.
};

/// Returns the name of a kind: "keep", "motion", "route", "stop".
const char* ToString(ReplanKind kind);

/// How a plan was found during the run, stored in PlanDiagnostics::replan.
struct ReplanDiagnostics {
  std::string kind;  ///< Kind: "motion", "detour", "back_on_route" or "brake".
  /// Result of the search for a motion along the route, if there was a search.
  std::optional<AlongPlan> along{};
  std::optional<DetourFindings> detour{};
  std::optional<double> deceleration{};  ///< Deceleration of braking [m/s^2].
};
void Visit(DiagnosticsVisitor& out, const ReplanDiagnostics& own);

struct Replanned {
  ReplanKind kind = ReplanKind::kKeep;
  /// The new plan, whose stations begin beside the car. If the new plan ends before the goal,
  /// Plan::blocked states the reason. PlanDiagnostics::replan contains the ReplanDiagnostics. The
  /// new plan is empty if the old plan is kept.
  FeasiblePlan plan;
};

/// The first time at which the car, following its plan, comes too close to a known obstacle.
struct PredictedConflict {
  double time = 0.0;     ///< Time from now [s].
  double station = 0.0;  ///< Station on the plan [m].
  std::size_t obstacle = 0;
};

/// Predicts the first conflict of a car that drives the plan from `station` on, at the planned
/// speeds and `offset` [m] to the left of the plan. Tests for a conflict every 0.1 s. Finds the
/// start of the conflict to 0.1 ms by bisection. Returns nullopt if there is no conflict within
/// `look_ahead` [s].
std::optional<PredictedConflict> PredictConflict(const VehicleParams& vehicle,
                                                 const Reference& reference, double station,
                                                 const std::vector<MovingBox>& obstacles,
                                                 double distance, double look_ahead,
                                                 double offset = 0.0);

/// Returns whether an obstacle stands in a turn: the path beyond `station` is curved at a place
/// that is closer to the obstacle than `distance` [m].
bool StandsInTurn(const VehicleParams& vehicle, const Path& path, double station,
                  const OrientedBox& obstacle, double distance);

/// Returns whether waiting may help: a moving obstacle is closer than `distance` [m] to the next 30
/// m of a path, or will be so within a minute.
bool MightClear(const VehicleParams& vehicle, const Path& path, double station,
                const std::vector<MovingBox>& obstacles, double distance);

/// Keeps the current plan if it is clear, and is the route or a motion to the goal. Otherwise uses
/// the first available option in this order: the rest of the route, if it is clear and the car is
/// back on the route; a motion that passes the obstacle; a detour that the comparator prefers; a
/// motion that stops or continues for now; the current plan, if it is clear; braking.
///
/// Before a standing obstacle, the car brakes at the deceleration of the speed limits, to stop half
/// a meter before the conflict. If the distance is too short, the car brakes at once, at the
/// constant deceleration that this stop requires, at most `max_deceleration`. Before a moving
/// obstacle, the car brakes at once, at the smallest deceleration that avoids the obstacle. This
/// deceleration is one of eight values from the deceleration of the speed limits to the hardest
/// one. If no value avoids the obstacle, the car brakes as hard as possible. The car never brakes
/// harder than `max_deceleration`, even if that is less than the deceleration of the speed limits.
///
/// Every new plan passes MakeFeasible. A route is slowed down where it exceeds the grip of the
/// road; a motion that exceeds the grip is not used. A braking plan that exceeds the limits at any
/// speed is driven anyway, with a note, because no alternative is left.
///
/// Guarantees: a new plan begins with the planned steering of the old plan beside the car, or with
/// the actual steering if the car has strayed. The look-ahead is at least the time that the car
/// needs to stop from the mission's speed, plus two periods. The same input gives the same bytes.
/// New plans have no reverse segments. Errors: InternalError for options without a method. Cost:
/// the cost of the motions and detours that are evaluated.
Replanned Replan(const ReplanRequest& request, const Driving& driving,
                 const ReplanOptions& options);

}  // namespace trackbed
