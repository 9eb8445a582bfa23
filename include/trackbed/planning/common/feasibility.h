#pragma once

#include <string>
#include <utility>
#include <vector>

#include "trackbed/planning/common/planner.h"

/// Tests whether a car can drive a plan, in the same way for the plans of all planners.
///
/// Symbols, at the station s: delta(s) is the steering angle of the plan's path and schedule, v(s)
/// the planned speed, kappa(s) the curvature of the path, and mu(s) the friction coefficient
/// between tyres and road. The limits of the car's steering angle and steering rate are delta_max
/// and omega_delta.
///
/// A plan is feasible if all of the following hold.
///
///   * The plan begins at the car's pose and speed and, if the car is rolling, with the curvature
///     of the car's steering angle. The plan's start pose may differ from the car's pose by 1 mm
///     (for a small car, a thousandth of its wheelbase) and 1 mrad.
///   * The steering angle is within its limit: |delta| <= delta_max.
///   * The steering rate along the steering schedule is within its limit: v |d delta/ds| <=
///     omega_delta.
///   * The lateral acceleration is within the grip: v^2 |kappa| <= mu_y g cos(theta), minus
///     gravity's pull toward the outside of the bend. The angle theta is the slope of the road.
///   * The deceleration is at most twice the deceleration of the speed limits, because the speed
///     controller brakes no harder. The deceleration is also within the grip of tyres and brakes
///     under the load on the slope, minus gravity's pull downhill.
///   * The acceleration is within the limits of the run and the tyres, minus gravity's pull uphill.
///   * The accelerations along and across the path, each increased by gravity's opposing pull, are
///     together within the friction ellipse with the semi-axes mu_x g cos(theta) and mu_y g
///     cos(theta).
///   * The car can stand still on every slope on the way, and climb it.
///   * The speed v is at most the car's top speed.
///
/// Gravity never raises a limit: the help of a bank in a bend, or of an uphill slope in braking, is
/// ignored. A plan with speeds at the car's limit (PlanRequest::limits), or the remainder of such a
/// plan, must stay within its g-g-v diagram. For plans with speeds at the car's limit, the g-g-v
/// diagram replaces the conditions on acceleration, slope and top speed.
namespace trackbed {

/// The change that would bring a plan back within a limit.
enum class Remedy {
  kNone,        ///< Neither lower speeds nor smaller accelerations bring the plan within the limit.
  kLowerSpeed,  ///< The car must drive the plan's path more slowly.
  kGentlerBraking,  ///< The plan needs a smaller deceleration.
  kGentlerDriving,  ///< The plan needs a smaller acceleration.
  kGentlerBends,    ///< The plan needs lower speeds in bends and smaller accelerations.
};

/// A limit of the car that a plan exceeds.
struct Excess {
  std::string what;       ///< Name of the limited quantity, such as "steering rate".
  double required = 0.0;  ///< Value of the quantity that the plan requires [unit].
  double limit = 0.0;     ///< Car's limit for the exceeded quantity [unit].
  std::string unit;       ///< Unit of the quantity, such as "rad/s".
  double station = 0.0;   ///< Station of the worst violation [m].
  Remedy remedy = Remedy::kNone;
  /// Cause of the violation and its remedy, as text for users; empty if the other members suffice.
  std::string hint{};
};

/// Largest planned deceleration, as a multiple of SpeedLimits::deceleration; the speed control can
/// brake this hard.
inline constexpr double kMaxBrakingFactor = 2.0;

/// Finds all limits that the plan exceeds, and returns one entry for each limited quantity, at the
/// place of its worst violation. Skips limits of the car that are unknown, that is 0 in the
/// vehicle's parameters. Computing time: 5 us per meter of path.
std::vector<Excess> FindExcesses(const Plan& plan, const PlanRequest& request);

/// How much MakeFeasible finds out about the cause of a refusal.
enum class Refusal {
  kBrief,  ///< Lists only the exceeded limits.
  /// Besides listing the limits, finds the highest feasible start speed if the car starts too fast.
  /// With kExplained, refusing a plan takes up to ten times as long as with kBrief.
  kExplained,
};

/// A plan that has passed the feasibility test of MakeFeasible. Only MakeFeasible creates a
/// FeasiblePlan, and cars are driven only along a FeasiblePlan. The path, speeds and steering of a
/// FeasiblePlan cannot be changed.
class FeasiblePlan {
 public:
  /// Makes an empty plan, without path and speed.
  FeasiblePlan() = default;

  /// Whether there is a plan. If there is no plan, Plan::status and Plan::reason state the cause.
  [[nodiscard]] bool ok() const { return plan_.ok(); }
  [[nodiscard]] const Plan& operator*() const { return plan_; }
  [[nodiscard]] const Plan* operator->() const { return &plan_; }
  operator const Plan&() const { return plan_; }  // NOLINT(google-explicit-constructor)

  /// Adds a remark for the user to the plan's notes. Remarks and diagnostics of a plan do not
  /// change how the car drives.
  void AddNote(std::string note) { plan_.notes.push_back(std::move(note)); }
  [[nodiscard]] PlanDiagnostics& diagnostics() { return plan_.diagnostics; }

 private:
  explicit FeasiblePlan(Plan plan) : plan_(std::move(plan)) {}
  friend FeasiblePlan MakeFeasible(Plan plan, const PlanRequest& request, Refusal refusal);

  Plan plan_;
};

/// Tests the plan, and applies the policy of the request if the plan exceeds a limit. The policy
/// slows the plan down where the plan exceeds the limit, rejects the plan (kInfeasible), or leaves
/// the plan unchanged. Plan::notes states how the plan was slowed down, or which limits an
/// unchanged plan exceeds. A plan whose status is not kOk stays unchanged. A plan that would have
/// to be slower than 0.1 m/s is rejected. With PlanRequest::limits, the function replaces the
/// planned speeds by the speeds at the car's limit. A plan with speeds at the car's limit is
/// rejected if the car cannot follow the path or starts too fast.
FeasiblePlan MakeFeasible(Plan plan, const PlanRequest& request, Refusal refusal = Refusal::kBrief);

/// Makes a PlanRequest that contains a vehicle, speed limits and a road, but no mission.
PlanRequest RequestOn(const RoadConditions& road, const VehicleParams& vehicle,
                      const SpeedLimits& speed);

/// Same as MakeFeasible, but for a plan that continues another plan: a rerouted plan, or a plan
/// made during the run. A plan that continues another plan begins at or near the car's pose
/// (replan.h, avoidance.h). The feasibility test of a continuing plan uses the start of this plan,
/// not the mission's start.
FeasiblePlan MakeFeasibleFromHere(Plan plan, const PlanRequest& request);

/// Computes the plan's speeds, for closed-loop and open-loop runs, from the plan's path, speed caps
/// and stops.
void SetSpeeds(Plan& plan, double start_speed, const SpeedLimits& limits);

/// Formats an exceeded limit, for example "steering rate 0.95 rad/s exceeds 0.151 rad/s at s = 42
/// m". If the excess has a hint (Excess::hint), the text ends with the hint in parentheses.
std::string ToString(const Excess& excess);

}  // namespace trackbed
