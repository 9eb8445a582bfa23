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

/// What the speeds of a plan are limited by, if the mission wants them at the limit.
struct SpeedAtLimit {
  GgvDiagram diagram;  ///< of all roads of the world
  LimitProfileOptions options{};
  Ground ground{};
};

/// What is known of a plan's speeds at the limit, for plan.json.
struct LimitProfileFindings {
  double share = 0.0;           ///< LimitProfileOptions::share
  double predicted_time = 0.0;  ///< from start to goal [s]; infinite if it stands still on the way
  double slowest = 0.0;         ///< lowest speed of a minimum between two accelerations [m/s]
  double slowest_s = 0.0;       ///< where [m]
  double lateral_max = 0.0;     ///< largest v^2 |kappa| [m/s^2]
  double driving_max = 0.0;     ///< largest acceleration [m/s^2]
  double braking_max = 0.0;     ///< largest deceleration [m/s^2]
};
void Visit(DiagnosticsVisitor& out, const LimitProfileFindings& findings);

/// The stations of a part of the path, at most a fifth of the wheelbase and 0.5 m apart, both ends
/// and every joint of segments included. Beyond the path's end it goes straight on. Slopes are
/// those of the ground under both axles, by what each carries, over the wheelbase; the road is the
/// more slippery one of both axles'; caps count at the stations within them and next to them. On
/// reverse segments the diagram is used as if the car drove forward.
std::vector<LimitStation> StationsAlong(const Path& path, const Stations& part,
                                        const PlanRequest& request,
                                        const std::vector<SpeedCap>& caps);

/// Sets the plan's speeds, of the path and of the open loop, to those at the limit of
/// `request.limits`, within caps, with a stop at each cusp and stop of the plan; adds what is known
/// of them to its diagnostics and a note. The place where the start is too fast, if there is one.
std::optional<LimitExcess> SetSpeedsAtLimit(Plan& plan, const PlanRequest& request,
                                            const std::vector<SpeedCap>& caps);

}  // namespace trackbed
