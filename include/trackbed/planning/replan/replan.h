#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/replan/along_route.h"
#include "trackbed/planning/replan/detour.h"
#include "trackbed/planning/replan/predicted_conflict.h"
#include "trackbed/planning/replan/replan_options.h"

/// Replans during a run, with the obstacles known so far. The new plan is a motion along the route
/// (along_route.h), a detour if no motion passes the obstacle (detour.h), or braking before the
/// obstacle if there is no detour.
///
/// During a run, the car drives one plan after the other. A new plan begins at the point of the old
/// plan nearest to the car. At its start, the new plan has the curvature, speed and acceleration of
/// the old plan, so that these quantities do not jump. If the car has strayed from its plan, the
/// new plan begins with the car's actual pose, steering and speed.
namespace trackbed {

/// The state of a run, which consists of the route, the current plan and the car's stations on the
/// route and on the plan.
struct Driving {
  Plan route;                  ///< Plan that leads to the goal.
  RouteFrame frame;            ///< The route, prepared by MakeRouteFrame for planning motions.
  Plan plan;                   ///< Current plan, which is the route or a motion along the route.
  bool on_route = true;        ///< Whether the current plan is the route.
  double station = 0.0;        ///< Station of the car on the current plan [m].
  double route_station = 0.0;  ///< Approximate station of the car on the route [m].
};

struct ReplanRequest {
  VehicleParams vehicle;
  SpeedLimits speed;
  Wind wind;
  double time = 0.0;  ///< Present time since the start of the run [s].
  /// Actual pose and speed of the car, and the curvature that results from its steering angle.
  MotionState car;
  /// Whether the car is so far from the current plan that a new plan must start at the car's actual
  /// pose.
  bool strayed = false;
  /// Largest deceleration that tyres, brakes and the road ahead allow [m/s^2]; 0: the deceleration
  /// of the speed limits applies.
  double max_deceleration = 0.0;
  std::vector<MovingBox> obstacles;  ///< All known obstacles, at their present positions.
  std::uint64_t seed = 0;
  RoadConditions road{};  ///< Conditions of the road that limit new plans.
};

enum class ReplanKind {
  kKeep,    ///< Keep the current plan.
  kMotion,  ///< Drive a new motion along the route.
  /// Return to the route, or take a detour; the new plan then becomes the route.
  kRoute,
  kStop,  ///< Brake to a stop, before the obstacle if possible.
};

/// Returns the name of a kind of replanning: "keep", "motion", "route", "stop".
const char* ToString(ReplanKind kind);

/// Describes how a plan was found during the run, stored in PlanDiagnostics::replan.
struct ReplanDiagnostics {
  std::string kind;  ///< Kind of the new plan: "motion", "detour", "back_on_route" or "brake".
  /// Result of the search for a motion along the route, if there was a search.
  std::optional<AlongPlan> along{};
  std::optional<DetourFindings> detour{};
  /// Deceleration of the car, if the new plan is to brake [m/s^2].
  std::optional<double> deceleration{};
};
void Visit(DiagnosticsVisitor& out, const ReplanDiagnostics& own);

struct Replanned {
  ReplanKind kind = ReplanKind::kKeep;
  /// The new plan, whose stations count from the point nearest to the car. If the new plan ends
  /// before the goal, Plan::blocked states the reason. The diagnostics of the new plan contain the
  /// ReplanDiagnostics (PlanDiagnostics::replan). The new plan is empty if the old plan is kept.
  FeasiblePlan plan;
};

/// Replans at the present moment of a run. Keeps the current plan if this plan is clear of
/// obstacles and leads to the goal. If the current plan is not kept, Replan uses the first
/// available one of six options. Option 1 of replanning is the rest of the route, if the route is
/// clear and the car is back on the route. Option 2 of replanning is a motion that passes the
/// obstacle. Option 3 of replanning is a detour that the comparator prefers. Option 4 of replanning
/// is a motion along the route that stops or continues for now. Option 5 of replanning is the
/// current plan, if this plan is clear of obstacles. Option 6 of replanning is braking.
///
/// Before a standing obstacle, the car brakes at the deceleration of the speed limits, and stops
/// half a meter before the predicted conflict. If the distance to a standing obstacle is too short
/// for the deceleration of the speed limits, the car brakes at once. When the car brakes at once
/// before a standing obstacle, its deceleration is constant and as large as the stop requires, but
/// at most `max_deceleration`. Before a moving obstacle, the car brakes at once, at the smallest
/// deceleration that avoids the obstacle. The deceleration before a moving obstacle is one of eight
/// values between the deceleration of the speed limits and the largest possible deceleration. If
/// none of the eight decelerations avoids the obstacle, the car brakes as hard as possible. The car
/// never brakes harder than `max_deceleration`, even if `max_deceleration` is less than the
/// deceleration of the speed limits.
///
/// MakeFeasible tests every new plan. A new route is slowed down where it exceeds the grip of the
/// road; a motion that exceeds the grip is not used. A braking plan that MakeFeasible cannot make
/// feasible is driven anyway, with a note, because no alternative is left.
///
/// Guarantees: a new plan begins with the steering angle that the old plan has at the point nearest
/// to the car. If the car has strayed from its plan, the new plan begins with the car's actual
/// steering angle. Conflicts with obstacles are predicted over at least the time that the car needs
/// to stop from the mission's speed, plus two replanning periods. The same input always yields a
/// bit-identical result. New plans have no reverse segments. Throws InternalError if the options
/// contain no method for motions along the route. The computing time is the sum of the computing
/// times of the motions and detours that are tried.
Replanned Replan(const ReplanRequest& request, const Driving& driving,
                 const ReplanOptions& options);

}  // namespace trackbed
