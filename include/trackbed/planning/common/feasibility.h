#pragma once

#include <string>
#include <utility>
#include <vector>

#include "trackbed/planning/common/planner.h"

/// Whether a car can drive a plan: one test for all planners.
///
/// Symbols: delta(s) the steering of the plan's path and schedule, omega_delta the car's steering
/// rate, v(s) the plan's speed, kappa(s) its curvature, mu(s) the friction coefficient of tyres and
/// road under the car.
///
/// A plan is feasible if all of the following hold.
///
///   * It begins at the car's pose and speed, and for a rolling car with the curvature of the
///     steering angle. The tolerances are 1 mm (for a small car, a thousandth of its wheelbase) and
///     1 mrad.
///   * The steering is within its limit: |delta| <= delta_max.
///   * The steering rate is within its limit over the steering schedule: v |d delta/ds| <=
///     omega_delta.
///   * The lateral acceleration is within the grip: v^2 |kappa| <= mu_y g cos(theta), minus
///     gravity's pull toward the outside of the bend. theta is the slope of the road.
///   * The deceleration is at most twice that of the speed limits, which is the speed controller's
///     maximum. The deceleration is also within the grip of tyres and brakes under the load on the
///     slope, minus gravity downhill.
///   * The acceleration is within the limits of the run and the tyres, minus gravity uphill.
///   * The accelerations along and across the path, each with gravity's pull against it, are
///   together within the
///     friction ellipse with the semi-axes mu_x g cos(theta) and mu_y g cos(theta).
///   * The car can stand on and climb every slope on the way.
///   * The speed v is at most the car's top speed.
///
/// Gravity never raises a limit: a bank that helps in a bend, or an uphill slope that helps to
/// brake, is ignored. Speeds at the limit (PlanRequest::limits, or the remainder of such a plan)
/// must meet their g-g-v diagram instead of the conditions on acceleration, slope and top speed.
namespace trackbed {

/// The change that would bring a plan back within a limit.
enum class Remedy {
  kNone,            ///< No change: the path does not suit the car.
  kLowerSpeed,      ///< A lower speed on the same path.
  kGentlerBraking,  ///< A smaller deceleration.
  kGentlerDriving,  ///< A smaller acceleration.
  kGentlerBends,    ///< Less speed in bends, and smaller accelerations.
};

/// A limit of the car that a plan exceeds.
struct Excess {
  std::string what;       ///< Quantity, such as "steering rate".
  double required = 0.0;  ///< Required value [unit].
  double limit = 0.0;     ///< Limit of the car [unit].
  std::string unit;       ///< Unit, such as "rad/s".
  double station = 0.0;   ///< Station of the worst violation [m].
  Remedy remedy = Remedy::kNone;
};

/// Finds all limits that the plan exceeds: one entry for each quantity, at its worst place. Skips
/// limits that are unknown in the vehicle's parameters (0). Cost: 5 us per meter.
std::vector<Excess> FindExcesses(const Plan& plan, const PlanRequest& request);

/// A plan that has passed MakeFeasible. Only MakeFeasible makes such plans, and a car is driven
/// only along such plans. The driven part of the plan cannot be changed afterwards.
class FeasiblePlan {
 public:
  /// Makes an empty plan, without path and speed.
  FeasiblePlan() = default;

  /// Whether there is a plan. If not, Plan::status and Plan::reason say why.
  [[nodiscard]] bool ok() const { return plan_.ok(); }
  [[nodiscard]] const Plan& operator*() const { return plan_; }
  [[nodiscard]] const Plan* operator->() const { return &plan_; }
  operator const Plan&() const { return plan_; }  // NOLINT(google-explicit-constructor)

  /// Adds a remark. Remarks and diagnostics do not change the driven part of the plan.
  void AddNote(std::string note) { plan_.notes.push_back(std::move(note)); }
  [[nodiscard]] PlanDiagnostics& diagnostics() { return plan_.diagnostics; }

 private:
  explicit FeasiblePlan(Plan plan) : plan_(std::move(plan)) {}
  friend FeasiblePlan MakeFeasible(Plan plan, const PlanRequest& request);

  Plan plan_;
};

/// Applies the request's policy where the plan exceeds a limit: slows the plan down there, rejects
/// it (kInfeasible), or leaves it unchanged. Plan::notes states which. A plan that is not ok stays
/// unchanged. A plan that would have to be slower than 0.1 m/s is rejected. With
/// PlanRequest::limits, the speeds become those at the limit. The plan is then rejected if the car
/// cannot follow its path or starts too fast.
FeasiblePlan MakeFeasible(Plan plan, const PlanRequest& request);

/// Makes a request for a vehicle on a road, without a mission.
PlanRequest RequestOn(const RoadConditions& road, const VehicleParams& vehicle,
                      const SpeedLimits& speed);

/// As MakeFeasible, for a plan that continues another plan: a rerouted plan, or one made during the
/// run. A continuing plan begins at or near the car (replan.h, avoidance.h). The start of that plan
/// replaces the mission's start.
FeasiblePlan MakeFeasibleFromHere(Plan plan, const PlanRequest& request);

/// Sets the plan's speeds, for the path and the open loop, from its path, caps and stops.
void SetSpeeds(Plan& plan, double start_speed, const SpeedLimits& limits);

/// Formats a violation: "a steering rate of 0.95 rad/s at s = 42 m (limit 0.1506 rad/s)".
std::string ToString(const Excess& excess);

}  // namespace trackbed
