#pragma once

#include <string>
#include <vector>

#include "trackbed/planning/common/planner.h"

/// Whether a car can drive a plan: one test for the plans of all planners.
///
/// Symbols: delta(s) the steering of the plan's path and schedule, omega_delta the car's steering
/// rate, v(s) the plan's speed, kappa(s) its curvature, mu(s) the friction coefficient of tyres and
/// road under the car.
///
/// A plan is feasible if
///   * it begins where the car is (1 mm, of a small car a thousandth of its wheelbase, and 1 mrad),
///     at the car's speed, and for a car that rolls with the curvature of its steering angle
///     (1 mrad),
///   * |delta| <= delta_max,
///   * v |d delta/ds| <= omega_delta over the steering schedule,
///   * v^2 |kappa| <= mu_y g,
///   * it brakes no harder than twice the deceleration of the speed limits, which is what the speed
///     controller gives at most, nor than the tyres and brakes hold, and accelerates no harder than
///     the run and its tyres,
///   * v is at most the car's top speed.
namespace trackbed {

/// What would bring a plan back within a limit.
enum class Remedy {
  kNone,            ///< nothing: its path does not suit the car
  kLowerSpeed,      ///< less speed on the same path
  kGentlerBraking,  ///< a smaller deceleration
  kGentlerDriving,  ///< a smaller acceleration
};

/// Something that a plan asks beyond what the car can do.
struct Excess {
  std::string what;      ///< "steering rate"
  double asked = 0.0;    ///< [unit]
  double limit = 0.0;    ///< [unit]
  std::string unit;      ///< "rad/s"
  double station = 0.0;  ///< where [m]
  Remedy remedy = Remedy::kNone;
};

/// Everything that the plan asks too much of, one entry for each quantity, at its worst place.
/// Limits that the vehicle's parameters do not know (0) are not checked. Cost: 5 us a meter.
std::vector<Excess> FindExcesses(const Plan& plan, const PlanRequest& request);

/// The plan as the request wants it where it asks too much: slowed down there, refused
/// (kInfeasible), or left as it is; Plan::notes tell. A plan that is not ok is left as it is.
/// Slower than 0.1 m/s no plan is made: it is refused. With PlanRequest::limits its speeds become
/// those at the limit, and it is refused if the car cannot follow its path or starts too fast.
Plan MakeFeasible(Plan plan, const PlanRequest& request);

/// Sets the plan's speeds, of the path and of the open loop, from its path, caps and stops.
void SetSpeeds(Plan& plan, double start_speed, const SpeedLimits& limits);

/// "a steering rate of 0.95 rad/s at s = 42 m (limit 0.1506 rad/s)"
std::string ToString(const Excess& excess);

}  // namespace trackbed
