#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/replan/replan_options.h"
#include "trackbed/planning/sampling/comparator.h"

/// Plans detours around obstacles with any planner that avoids obstacles. A detour leaves the car's
/// current plan before the obstacle that blocks the plan, and rejoins the route beyond the
/// obstacle.
namespace trackbed {

struct DetourRequest {
  VehicleParams vehicle;
  SpeedLimits speed;           ///< The mission's limits on speed and acceleration.
  Plan driven;                 ///< Plan that the car is currently driving.
  double station = 0.0;        ///< Station of the car on the plan `driven` [m].
  double station_speed = 0.0;  ///< Speed of the car at `station` [m/s].
  /// Plan that leads to the goal: `driven` itself, or the route that `driven` follows.
  Plan route;
  double route_station = 0.0;          ///< Station of the car on `route` [m].
  std::vector<OrientedBox> obstacles;  ///< All known obstacles that stand still.
  double safe_distance = 0.3;  ///< Distance from the car below which an obstacle blocks a path [m].
  Wind wind;
  double time = 0.0;  ///< Time since the start of the run [s].
  std::uint64_t seed = 0;
  RoadConditions road{};  ///< Conditions of the road that limit the new route.
};

/// The result of a search for a detour.
struct Detour {
  /// New route from the car's station to the goal; none: keep the current plan.
  std::optional<FeasiblePlan> route;
  /// Stations at which the new route leaves the driven path and rejoins the old route [m].
  Stations replaced;
  PathScore current;  ///< Score of the path that the car is currently driving.
  /// Score of the best alternative path; its total is infinite if there is no alternative.
  PathScore best;
  int tried = 0;     ///< Number of times that the planner of detours was called.
  long samples = 0;  ///< Number of random samples that the planner drew in all calls.
  std::string why;   ///< Reason why there is no detour, else empty.
};

/// Maximum number of random samples in a search for a detour; RRT* takes about 2 s for this number.
inline constexpr long kMaxDetourSamples = 200'000;

/// Diagnostics of a search for a detour, without the resulting plan.
struct DetourFindings {
  std::string planner;            ///< Name of the planner that searched for detours.
  int tried = 0;                  ///< Number of times that the planner of detours was called.
  PathScore current;              ///< Score of the path that the car is currently driving.
  std::optional<PathScore> best;  ///< Score of the best alternative path.
  /// Stations between which the new route replaces the old route [m]; none if there is no detour.
  std::optional<Stations> replaced{};
  std::string why;  ///< Reason why there is no detour, else empty.
};
void Visit(DiagnosticsVisitor& out, const DetourFindings& own);

/// Searches for a detour if a standing obstacle blocks the route; otherwise, returns no detour.
/// Candidate paths leave the driven path on a straight stretch, as early as the car can. The
/// candidate paths rejoin the route on straight stretches beyond the last obstacle that blocks the
/// route, or at the end of the route. The comparator (comparator.h) chooses the best candidate
/// path, and keeps the current path unless the best candidate has a lower score.
///
/// Guarantees: the new route begins with a part of the driven path that is long enough for the
/// steering to follow the new route. Beyond the part shared with the driven path, the new route
/// keeps the planner's safe distance from every obstacle. On the new route, the car slows down for
/// the corners without braking harder than the limits allow. Throws InternalError if the planner
/// does not avoid obstacles or may plan reverse segments. In each attempt, the planner plans up to
/// 18 paths. If the first attempt finds no path, PlanDetour makes no other attempts. After
/// kMaxDetourSamples random samples, the planner plans no further path, and the best candidate so
/// far is used.
Detour PlanDetour(const DetourRequest& request, const PlannerOptions& planner,
                  const DetourChoice& choice);

/// Returns the stretches of a path beyond `station` on which the car is closer to an obstacle than
/// `distance` [m], in order.
std::vector<Stations> BlockedStretches(const VehicleParams& vehicle, const Path& path,
                                       double station, const std::vector<OrientedBox>& obstacles,
                                       double distance);

}  // namespace trackbed
