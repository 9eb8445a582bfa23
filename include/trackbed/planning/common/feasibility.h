#pragma once

#include <string>
#include <utility>
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
///   * v^2 |kappa| <= mu_y g cos(theta), less gravity's pull toward the outside of the bend, theta
///     being the slope of the road,
///   * it brakes no harder than twice the deceleration of the speed limits, which is what the speed
///     controller gives at most, nor than the tyres and brakes hold under that load, less gravity
///     downhill, and accelerates no harder than the run and its tyres, less gravity uphill,
///   * the car can hold, and climb, every slope on the way,
///   * v is at most the car's top speed.
///
/// Gravity is never credited: a bank that helps in a bend, or an uphill that helps to brake, leaves
/// the limit as it is. Speeds at the limit (PlanRequest::limits, or a rest of such a plan) are held
/// to their g-g-v diagram instead of the last five rows.
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
  std::string what;       ///< "steering rate"
  double required = 0.0;  ///< [unit]
  double limit = 0.0;     ///< [unit]
  std::string unit;       ///< "rad/s"
  double station = 0.0;   ///< where [m]
  Remedy remedy = Remedy::kNone;
};

/// Everything that the plan asks too much of, one entry for each quantity, at its worst place.
/// Limits that the vehicle's parameters do not know (0) are not checked. Cost: 5 us a meter.
std::vector<Excess> FindExcesses(const Plan& plan, const PlanRequest& request);

/// A plan that has passed MakeFeasible, the only function that makes one, and the only kind of plan
/// that a car is driven along. Nothing that is driven can change afterwards.
class FeasiblePlan {
 public:
  /// An empty plan: no path, and no speed.
  FeasiblePlan() = default;

  /// Whether there is a plan; else Plan::status and Plan::reason say why not.
  [[nodiscard]] bool ok() const { return plan_.ok(); }
  [[nodiscard]] const Plan& operator*() const { return plan_; }
  [[nodiscard]] const Plan* operator->() const { return &plan_; }
  operator const Plan&() const { return plan_; }  // NOLINT(google-explicit-constructor)

  /// Remarks and findings do not change what is driven.
  void AddNote(std::string note) { plan_.notes.push_back(std::move(note)); }
  [[nodiscard]] PlanDiagnostics& diagnostics() { return plan_.diagnostics; }

 private:
  explicit FeasiblePlan(Plan plan) : plan_(std::move(plan)) {}
  friend FeasiblePlan MakeFeasible(Plan plan, const PlanRequest& request);

  Plan plan_;
};

/// The plan as the request wants it where it asks too much: slowed down there, refused
/// (kInfeasible), or left as it is; Plan::notes tell. A plan that is not ok is left as it is.
/// Slower than 0.1 m/s no plan is made: it is refused. With PlanRequest::limits its speeds become
/// those at the limit, and it is refused if the car cannot follow its path or starts too fast.
FeasiblePlan MakeFeasible(Plan plan, const PlanRequest& request);

/// A request for a vehicle on a road, without a mission.
PlanRequest RequestOn(const RoadConditions& road, const VehicleParams& vehicle,
                      const SpeedLimits& speed);

/// MakeFeasible for a plan that continues another one: a rerouted plan, or one made during the run.
/// It begins beside the car or at the car (replan.h, avoidance.h); its own start replaces the
/// mission's.
FeasiblePlan MakeFeasibleFromHere(Plan plan, const PlanRequest& request);

/// Sets the plan's speeds, of the path and of the open loop, from its path, caps and stops.
void SetSpeeds(Plan& plan, double start_speed, const SpeedLimits& limits);

/// "a steering rate of 0.95 rad/s at s = 42 m (limit 0.1506 rad/s)"
std::string ToString(const Excess& excess);

}  // namespace trackbed
