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

/// The limits for a plan's speeds, if the mission wants them at the car's limit.
struct SpeedAtLimit {
  GgvDiagram diagram;  ///< of all roads of the world
  LimitProfileOptions options{};
  Ground ground{};
};

/// Diagnostics of a plan's speeds at the limit, for plan.json.
struct LimitProfileFindings {
  double share = 0.0;           ///< LimitProfileOptions::share
  double predicted_time = 0.0;  ///< from start to goal [s]; infinite if it stops on the way
  double slowest = 0.0;         ///< lowest speed of a minimum between two accelerations [m/s]
  double slowest_s = 0.0;       ///< station of it [m]
  double lateral_max = 0.0;     ///< largest v^2 |kappa| [m/s^2]
  double driving_max = 0.0;     ///< largest acceleration [m/s^2]
  double braking_max = 0.0;     ///< largest deceleration [m/s^2]
};
void Visit(DiagnosticsVisitor& out, const LimitProfileFindings& findings);

/// The stations of a part of the path, at most a fifth of the wheelbase and 0.5 m apart, including
/// both ends and every joint of segments. Beyond its end the path continues straight. Slopes are
/// those of the ground under both axles, weighted by axle load, over the wheelbase; the friction is
/// the lower one of both axles; caps apply at the stations within them and next to them. Reverse
/// segments use the diagram as if the car drove forward.
std::vector<LimitStation> StationsAlong(const Path& path, const Stations& part,
                                        const PlanRequest& request,
                                        const std::vector<SpeedCap>& caps);

/// Sets the plan's speeds, for the path and the open loop, to the limit of `request.limits`, within
/// caps, with a stop at each cusp and stop of the plan. Adds diagnostics and a note. Returns the
/// place at which the start is too fast, if any.
std::optional<LimitExcess> SetSpeedsAtLimit(Plan& plan, const PlanRequest& request,
                                            const std::vector<SpeedCap>& caps);

}  // namespace trackbed
