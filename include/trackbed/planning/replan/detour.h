#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/replan/replan_options.h"
#include "trackbed/planning/sampling/comparator.h"

/// Another way to the goal, by any planner that keeps clear of obstacles itself: off the plan that
/// is driven before what blocks it, and back on the route behind that.
namespace trackbed {

struct DetourRequest {
  VehicleParams vehicle;
  SpeedLimits speed;                   ///< of the mission
  Plan driven;                         ///< the plan that is driven
  double station = 0.0;                ///< of the car on it [m]
  double station_speed = 0.0;          ///< there [m/s]
  Plan route;                          ///< to the goal; the driven one, or the one it follows
  double route_station = 0.0;          ///< of the car on it [m]
  std::vector<OrientedBox> obstacles;  ///< that are known and stand
  double safe_distance = 0.3;          ///< from them, nearer ones block a path [m]
  Wind wind;
  double time = 0.0;  ///< [s]
  std::uint64_t seed = 0;
};

/// What came of it.
struct Detour {
  std::optional<Plan> route;  ///< from the car's station on, to the goal; none: stay
  Stations replaced;  ///< of the new route: where it leaves the driven path, and is back [m]
  PathScore current;  ///< of the path as it is
  PathScore best;     ///< of the best other one; its total is infinite if there is none
  int tried = 0;      ///< times the planner was asked
  std::string why;    ///< there is none, for people
};

/// A search for a detour, without the plan.
struct DetourFindings {
  std::string planner;                 ///< its name
  int tried = 0;                       ///< times it was asked
  PathScore current;                   ///< of the path as it is
  std::optional<PathScore> best;       ///< of the best other one
  std::optional<Stations> replaced{};  ///< of the new route; none: there is no detour [m]
  std::string why;                     ///< there is none, for people
};
void Visit(DiagnosticsVisitor& out, const DetourFindings& own);

/// Looks for a path only where something that stands blocks the route. Leaves the driven path where
/// it is straight, as early as the car can, and comes back on straight stretches of the route
/// behind the last of what blocks it or at its end. Of all that is found the comparator takes the
/// best, and that only if it is better than going on as before.
///
/// Guarantees: the new route begins with the driven one, its curvature included, for as long as the
/// steering needs to follow; keeps the planner's own distance from every obstacle beyond; is slow
/// enough for its corners without braking harder than the limits. Errors: InternalError for a
/// planner that does not keep clear or may go backwards. Cost: up to 18 plans
/// an attempt; one attempt if that finds nothing.
Detour PlanDetour(const DetourRequest& request, const PlannerOptions& planner,
                  const DetourChoice& choice);

/// The stretches of a path, from `station` on, on which the car is closer to an obstacle than
/// `distance`; one after the other.
std::vector<Stations> BlockedStretches(const VehicleParams& vehicle, const Path& path,
                                       double station, const std::vector<OrientedBox>& obstacles,
                                       double distance);

}  // namespace trackbed
