#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/replan/along_route.h"
#include "trackbed/planning/replan/detour.h"
#include "trackbed/planning/replan/replan_options.h"

/// Planning again while driving, on what is known by then: motions along the route (along_route.h),
/// a detour when those lead past nothing (detour.h), and to rest before what stands in the way when
/// there is neither.
///
/// Plans are driven one after the other. A new one begins at the planned point beside the car, with
/// the curvature, speed and acceleration planned there, so that nothing jumps when it is taken up;
/// or with the car's own pose, steering and speed if it has strayed from its plan.
namespace trackbed {

/// What is being driven.
struct Driving {
  Plan route;                  ///< to the goal
  RouteFrame frame;            ///< of the route; see MakeRouteFrame
  Plan plan;                   ///< that is driven: the route or what leads along it
  bool on_route = true;        ///< the plan is the route
  double station = 0.0;        ///< of the car on the plan [m]
  double route_station = 0.0;  ///< near that of the car on the route [m]
};

struct ReplanRequest {
  VehicleParams vehicle;
  SpeedLimits speed;
  Wind wind;
  double time = 0.0;     ///< [s]
  MotionState car;       ///< as it is: pose, curvature of its steering, speed
  bool strayed = false;  ///< the car is far from the plan: start from where it is
  /// The hardest braking that tyres, brakes and the road ahead allow [m/s^2]; 0: no harder than
  /// the speed limits say.
  double max_deceleration = 0.0;
  std::vector<MovingBox> obstacles;  ///< known so far, where they are now
  std::uint64_t seed = 0;
};

enum class ReplanKind {
  kKeep,    ///< drive on as before
  kMotion,  ///< a motion along the route
  kRoute,   ///< the route itself again, or a detour: the plan is the new route
  kStop,    ///< brake, before what is in the way if that can be
};

/// "keep", "motion", "route", "stop".
const char* ToString(ReplanKind kind);

/// How a plan was found while driving: PlanDiagnostics::replan.
struct ReplanDiagnostics {
  std::string kind;                  ///< "motion", "detour", "back_on_route" or "brake"
  std::optional<AlongPlan> along{};  ///< the motion along the route, if one was searched for
  std::optional<DetourFindings> detour{};
  std::optional<double> deceleration{};  ///< of braking [m/s^2]
};
void Visit(DiagnosticsVisitor& out, const ReplanDiagnostics& own);

struct Replanned {
  ReplanKind kind = ReplanKind::kKeep;
  /// Its stations begin beside the car. Plan::blocked says why it ends before the goal, if it does;
  /// PlanDiagnostics::replan what was found (ReplanDiagnostics). The old one's copy when it is
  /// kept.
  Plan plan;
};

/// When the way that is driven is first too close to a known obstacle, if it is within the look.
struct PredictedConflict {
  double time = 0.0;     ///< from now [s]
  double station = 0.0;  ///< of the plan [m]
  std::size_t obstacle = 0;
};

/// Looks every 0.1 s along the plan's own speeds from `station` on, for a car that keeps `offset`
/// [m] left of it, and halves that time down to 0.1 ms for the moment when it began.
std::optional<PredictedConflict> PredictConflict(const VehicleParams& vehicle,
                                                 const Reference& reference, double station,
                                                 const std::vector<MovingBox>& obstacles,
                                                 double distance, double look_ahead,
                                                 double offset = 0.0);

/// Whether an obstacle stands in a turn: where it is closer than `distance` to the path, from
/// `station` on, that is bent.
bool StandsInTurn(const VehicleParams& vehicle, const Path& path, double station,
                  const OrientedBox& obstacle, double distance);

/// Whether waiting may help: something that moves is in the way of the next 30 m of a path, closer
/// than `distance`, or will be within a minute.
bool MightClear(const VehicleParams& vehicle, const Path& path, double station,
                const std::vector<MovingBox>& obstacles, double distance);

/// Keeps a route or a motion to the goal that is clear; else, in this order, the rest of the route
/// if the car is back on it and it is clear, a motion that leads on, a detour that the comparator
/// prefers, a motion that comes to rest or goes on for now, what is driven if it is clear, braking.
///
/// Braking, before what stands: at the speed limits' deceleration to rest half a meter before the
/// conflict if that is in time; else at once and evenly, as hard as that takes; else at
/// `max_deceleration`. What moves may come nearer: at once, with the mildest deceleration, in
/// eighths of the way from the limits' to the hardest, that keeps clear of it; else the hardest.
/// `max_deceleration` is never exceeded, even where the comfortable deceleration is above it.
///
/// Guarantees: the steering planned at the start of a new plan is that of the old one beside the
/// car, or the car's own if it has strayed. Looks ahead no less than it takes to stop from the
/// mission's speed, and two periods. Same input, same bytes. Does not plan backwards.
/// Errors: InternalError for options without a method. Cost: that of the motions and detours tried.
Replanned Replan(const ReplanRequest& request, const Driving& driving,
                 const ReplanOptions& options);

}  // namespace trackbed
