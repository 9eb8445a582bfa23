#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/replan/replan_options.h"
#include "trackbed/planning/sampling/comparator.h"

/// Detours by any planner that avoids obstacles: the detour leaves the driven plan before the
/// obstacle that blocks it, and rejoins the route behind it.
namespace trackbed {

struct DetourRequest {
  VehicleParams vehicle;
  SpeedLimits speed;                   ///< of the mission
  Plan driven;                         ///< the current plan
  double station = 0.0;                ///< of the car on `driven` [m]
  double station_speed = 0.0;          ///< of the car there [m/s]
  Plan route;                          ///< to the goal; `driven`, or the route that it follows
  double route_station = 0.0;          ///< of the car on `route` [m]
  std::vector<OrientedBox> obstacles;  ///< known obstacles that stand
  double safe_distance = 0.3;          ///< closer obstacles block a path [m]
  Wind wind;
  double time = 0.0;  ///< [s]
  std::uint64_t seed = 0;
  RoadConditions road{};  ///< that the new route is held to
};

/// The result of a search for a detour.
struct Detour {
  std::optional<FeasiblePlan> route;  ///< from the car's station to the goal; none: keep the plan
  /// Where the new route leaves the driven path, and rejoins it, in stations of the new route [m].
  Stations replaced;
  PathScore current;  ///< of the current path
  PathScore best;     ///< of the best alternative; its total is infinite without one
  int tried = 0;      ///< number of calls of the planner
  long samples = 0;   ///< random samples drawn in all of them
  std::string why;    ///< why there is no detour
};

/// Random samples that a detour may draw: about 2 s of RRT*.
inline constexpr long kMaxDetourSamples = 200'000;

/// Diagnostics of a search for a detour, without the plan.
struct DetourFindings {
  std::string planner;                 ///< its name
  int tried = 0;                       ///< number of calls of the planner
  PathScore current;                   ///< of the current path
  std::optional<PathScore> best;       ///< of the best alternative
  std::optional<Stations> replaced{};  ///< of the new route [m]; none: there is no detour
  std::string why;                     ///< why there is no detour
};
void Visit(DiagnosticsVisitor& out, const DetourFindings& own);

/// Searches only where a standing obstacle blocks the route. Candidates leave the driven path where
/// it is straight, as early as the car can, and rejoin the route on straight stretches behind the
/// last obstacle that blocks it, or at its end. The comparator chooses the best candidate, and
/// keeps the current path unless the candidate is better.
///
/// Guarantees: the new route begins with the driven one, including its curvature, as long as the
/// steering needs to follow; beyond that it keeps the planner's distance from every obstacle; it is
/// slow enough for its corners without braking harder than the limits. Errors: InternalError for a
/// planner that does not avoid obstacles or may go backwards. Cost: up to 18 plans per attempt; one
/// attempt if that finds nothing; no further plan after kMaxDetourSamples, whose best is taken.
Detour PlanDetour(const DetourRequest& request, const PlannerOptions& planner,
                  const DetourChoice& choice);

/// The stretches of a path, from `station` on, on which the car is closer to an obstacle than
/// `distance`, in order.
std::vector<Stations> BlockedStretches(const VehicleParams& vehicle, const Path& path,
                                       double station, const std::vector<OrientedBox>& obstacles,
                                       double distance);

}  // namespace trackbed
