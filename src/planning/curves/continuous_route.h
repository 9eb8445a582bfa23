#pragma once

#include "src/planning/curves/continuous_words.h"
#include "src/planning/curves/leg_costs.h"
#include "src/planning/curves/leg_speeds.h"
#include "trackbed/planning/curves/curve_planners.h"

namespace trackbed {

/// Requirements on a route of continuous curvature.
struct ContinuousRoute {
  CurveMotion motion = CurveMotion::kForwards;
  CurveObjective objective = CurveObjective::kLength;
  double max_lateral_acceleration = 1.0;  // [m/s^2]
  double max_steering_rate_fraction = 1.0;
  double radius = 1.0;          // smallest radius [m]
  double safe_distance = 0.0;   // of the footprint from obstacles [m]
  double min_speed = 0.1;       // lowest speed of a leg [m/s]
  bool turns_at_start = false;  // whether the wheels may be turned at a start at rest
  bool turns_at_goal = false;   // whether the wheels may be turned at the goal
};

/// Lowest speed at which a car follows a path [m/s]. On a leg without room for turns at the lowest
/// speed of the route, the car crawls at this speed.
inline constexpr double kCrawlingSpeed = 0.1;

/// Plans a path through the stops of the request whose curvature is continuous, except at cusps of
/// CurveMotion::kHybrid. Each leg is the cheapest word that is free of obstacles, for the sharpness
/// that the steering can follow at the speed of the leg. The curvature at each waypoint is the one
/// of a few choices for which the whole route is cheapest.
///
/// Without ContinuousRoute::turns_at_start, the wheels are straight at a start at rest; otherwise,
/// the time in which they turn before the start counts. Without ContinuousRoute::turns_at_goal, the
/// wheels are straight at the goal.
///
/// Uses and adds the costs of legs in `known`, which may come from other requests with the same
/// car, obstacles and speeds.
Plan PlanContinuousRoute(const ContinuousRoute& route, const PlanRequest& request, LegCosts& known);

/// Returns the limits on the motion along a route.
LegLimits LimitsOfMotion(const ContinuousRoute& route, const PlanRequest& request);

/// Returns the largest lateral acceleration on a path of continuous curvature [m/s^2]. The result
/// is the smaller of `most` and a share of the tyres' grip on a road with the factor `friction`.
double LateralAccelerationOnClothoids(const VehicleParams& vehicle, double friction, double most);

}  // namespace trackbed
