#pragma once

#include <vector>

#include "trackbed/path/reference.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/common/limit_profile.h"
#include "trackbed/planning/common/speed_profile_options.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/world/road.h"

/// Computes the speeds of plans that use the car's limits fully.
namespace trackbed {

struct Plan;
struct PlanRequest;

/// The inputs for computing speeds at the car's limit, if the mission requests such speeds.
struct SpeedAtLimit {
  /// The car's g-g-v diagram, for each friction factor that occurs in the scenario.
  GgvDiagram diagram;
  LimitProfileOptions options{};
  Ground ground{};
};

/// Diagnostics of planned speeds at the car's limit, for plan.json.
struct LimitProfileFindings {
  double share = 0.0;  ///< Usable fraction of the car's limits (LimitProfileOptions::share).
  /// Predicted driving time from start to goal [s]; infinite if the car stops on the way.
  double predicted_time = 0.0;
  /// Lowest speed at which the car changes from braking to accelerating [m/s]; 0 without such a
  /// change.
  double slowest = 0.0;
  double slowest_s = 0.0;    ///< Station at which the car has the speed `slowest` [m].
  double lateral_max = 0.0;  ///< Largest planned lateral acceleration v^2 |kappa| [m/s^2].
  double driving_max = 0.0;  ///< Largest planned acceleration [m/s^2].
  double braking_max = 0.0;  ///< Largest planned deceleration [m/s^2].
};
void Visit(DiagnosticsVisitor& out, const LimitProfileFindings& findings);

/// Returns stations along a part of the path, including both ends of the part and every joint of
/// segments. Neighboring stations are at most a fifth of the wheelbase, and at most 0.5 m, apart.
/// The path is extended straight beyond its end. The height and the slopes of the ground at a
/// station are means of the values at both axles, weighted by axle load. The slope along the path
/// is the height difference between the axles, divided by the wheelbase. The friction factor at a
/// station is the smaller of the factors under the two axles. A speed cap applies at the stations
/// in the range of the cap, and at the next station on either side. On reverse segments, the car's
/// limits are the same as for driving forward.
std::vector<LimitStation> StationsAlong(const Path& path, const Stations& part,
                                        const PlanRequest& request,
                                        const std::vector<SpeedCap>& caps);

/// Sets the plan's speeds, for closed-loop and open-loop runs, to the highest speeds within
/// `request.limits` and `caps`. The planned speed is 0 at each cusp and stop of the plan.
/// SetSpeedsAtLimit adds diagnostics and a note on the speeds to the plan. If the car starts too
/// fast to meet its limits, returns the place at which the car exceeds a limit.
std::optional<LimitExcess> SetSpeedsAtLimit(Plan& plan, const PlanRequest& request,
                                            const std::vector<SpeedCap>& caps);

}  // namespace trackbed
