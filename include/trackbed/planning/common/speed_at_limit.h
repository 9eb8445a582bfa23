#pragma once

#include <vector>

#include "trackbed/path/reference.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/common/limit_profile.h"
#include "trackbed/planning/common/speed_profile_options.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/world/road.h"

/// Speeds of plans at the car's limit.
namespace trackbed {

struct Plan;
struct PlanRequest;

/// The limits for speeds at the car's limit, if the mission requests such speeds.
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
  /// Lowest speed between an acceleration before and after it [m/s].
  double slowest = 0.0;
  double slowest_s = 0.0;    ///< Station of the lowest speed [m].
  double lateral_max = 0.0;  ///< Largest v^2 |kappa| [m/s^2].
  double driving_max = 0.0;  ///< Largest acceleration [m/s^2].
  double braking_max = 0.0;  ///< Largest deceleration [m/s^2].
};
void Visit(DiagnosticsVisitor& out, const LimitProfileFindings& findings);

/// The stations of a part of the path, at most a fifth of the wheelbase and 0.5 m apart, including
/// both ends and every joint of segments. Beyond its end the path continues straight. Slopes are
/// those of the ground under both axles, weighted by axle load, over the wheelbase. The friction is
/// the lower one of both axles. Caps apply at the stations within them and next to them. Reverse
/// segments use the diagram as if the car drove forward.
std::vector<LimitStation> StationsAlong(const Path& path, const Stations& part,
                                        const PlanRequest& request,
                                        const std::vector<SpeedCap>& caps);

/// Sets the plan's speeds, for the path and the open loop, to the limit of `request.limits` within
/// the caps. The car stops at each cusp and stop of the plan. Adds diagnostics and a note. If the
/// car starts too fast, returns the place at which it exceeds the limit.
std::optional<LimitExcess> SetSpeedsAtLimit(Plan& plan, const PlanRequest& request,
                                            const std::vector<SpeedCap>& caps);

}  // namespace trackbed
