#pragma once

#include <vector>

#include "trackbed/path/reference.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/common/limit_profile.h"
#include "trackbed/planning/common/speed_profile_options.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/world/road.h"

/// Computes the speeds of plans that drive at the car's limit.
namespace trackbed {

struct Plan;
struct PlanRequest;

/// The inputs for speeds at the car's limit, if the mission requests such speeds.
struct SpeedAtLimit {
  GgvDiagram diagram;  ///< g-g-v diagram that covers all roads of the world.
  LimitProfileOptions options{};
  Ground ground{};
};

/// Diagnostics of a plan's speeds at the limit, for plan.json.
struct LimitProfileFindings {
  double share = 0.0;  ///< Value of LimitProfileOptions::share.
  /// Time from start to goal [s]; infinite if the car stops on the way.
  double predicted_time = 0.0;
  /// Lowest speed between braking and a following acceleration [m/s]; 0: none.
  double slowest = 0.0;
  double slowest_s = 0.0;    ///< Station of the lowest speed [m].
  double lateral_max = 0.0;  ///< Largest v^2 |kappa| [m/s^2].
  double driving_max = 0.0;  ///< Largest acceleration [m/s^2].
  double braking_max = 0.0;  ///< Largest deceleration [m/s^2].
};
void Visit(DiagnosticsVisitor& out, const LimitProfileFindings& findings);

/// Returns stations along a part of the path, including both ends and every joint of segments. The
/// stations are at most a fifth of the wheelbase, and at most 0.5 m, apart. Beyond its end, the
/// path continues straight. Heights and slopes of the ground are means of both axles, weighted by
/// axle load. Slopes along the path are differences of height over the wheelbase. The friction
/// factor is the smaller one of the factors under the two axles. A speed cap applies at the
/// stations in its range and at the next station on either side. On reverse segments, the g-g-v
/// diagram applies as if the car drove forward.
std::vector<LimitStation> StationsAlong(const Path& path, const Stations& part,
                                        const PlanRequest& request,
                                        const std::vector<SpeedCap>& caps);

/// Sets the plan's speeds, for closed-loop and open-loop runs, to the limit of `request.limits`. No
/// speed exceeds the caps. The car stops at each cusp and stop of the plan. Adds diagnostics and a
/// note to the plan. If the car starts too fast, returns the place at which the car exceeds the
/// limit.
std::optional<LimitExcess> SetSpeedsAtLimit(Plan& plan, const PlanRequest& request,
                                            const std::vector<SpeedCap>& caps);

}  // namespace trackbed
