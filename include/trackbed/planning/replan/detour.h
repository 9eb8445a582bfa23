#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/replan/replan_options.h"
#include "trackbed/planning/sampling/comparator.h"

/// Plans detours with any planner that avoids obstacles. A detour leaves the driven plan before the
/// obstacle that blocks the plan, and rejoins the route behind the obstacle.
namespace trackbed {

struct DetourRequest {
  VehicleParams vehicle;
  SpeedLimits speed;           ///< Limits of the mission.
  Plan driven;                 ///< The current plan.
  double station = 0.0;        ///< Station of the car on `driven` [m].
  double station_speed = 0.0;  ///< Speed of the car at `station` [m/s].
  /// Plan to the goal: `driven`, or the route that `driven` follows.
  Plan route;
  double route_station = 0.0;          ///< Station of the car on `route` [m].
  std::vector<OrientedBox> obstacles;  ///< Known obstacles that stand still.
  double safe_distance = 0.3;          ///< Distance below which an obstacle blocks a path [m].
  Wind wind;
  double time = 0.0;  ///< Time in the run [s].
  std::uint64_t seed = 0;
  RoadConditions road{};  ///< Road conditions that limit the new route.
};

/// The result of a search for a detour.
struct Detour {
  /// New route from the car's station to the goal; none: keep the plan.
  std::optional<FeasiblePlan> route;
  /// Stations at which the new route leaves the driven path and rejoins the old route [m].
  Stations replaced;
  PathScore current;  ///< Score of the current path.
  /// Score of the best alternative; the total is infinite if there is no alternative.
  PathScore best;
  int tried = 0;     ///< Number of calls of the planner.
  long samples = 0;  ///< Number of random samples drawn in all calls of the planner.
  std::string why;   ///< Reason why there is no detour.
};

/// Maximum number of random samples in a search for a detour; RRT* takes about 2 s for this number.
inline constexpr long kMaxDetourSamples = 200'000;

/// Diagnostics of a search for a detour, without the plan.
struct DetourFindings {
  std::string planner;                 ///< Name of the planner.
  int tried = 0;                       ///< Number of calls of the planner.
  PathScore current;                   ///< Score of the current path.
  std::optional<PathScore> best;       ///< Score of the best alternative.
  std::optional<Stations> replaced{};  ///< Replaced stations of the new route [m]; none: no detour.
  std::string why;                     ///< Reason why there is no detour.
};
void Visit(DiagnosticsVisitor& out, const DetourFindings& own);

/// Searches for a detour only if a standing obstacle blocks the route. Candidate paths leave the
/// driven path on a straight stretch, as early as the car can. Candidate paths rejoin the route on
/// straight stretches behind the last obstacle that blocks the route, or at the end of the route.
/// The comparator chooses the best candidate, and keeps the current path unless the best candidate
/// is better.
///
/// Guarantees: the new route begins with a part of the driven path, with the same curvature, that
/// is long enough for the steering to follow the new route. Beyond this part, the new route keeps
/// the planner's safe distance from every obstacle. The new route is slow enough for its corners
/// without braking harder than the limits. Errors: InternalError for a planner that does not avoid
/// obstacles or may go backwards. Cost: up to 18 plans per attempt. If the first attempt finds no
/// path, there are no other attempts. After kMaxDetourSamples samples, no further path is planned,
/// and the best candidate so far is used.
Detour PlanDetour(const DetourRequest& request, const PlannerOptions& planner,
                  const DetourChoice& choice);

/// Returns the stretches of a path beyond `station` on which the car is closer to an obstacle than
/// `distance` [m], in order.
std::vector<Stations> BlockedStretches(const VehicleParams& vehicle, const Path& path,
                                       double station, const std::vector<OrientedBox>& obstacles,
                                       double distance);

}  // namespace trackbed
