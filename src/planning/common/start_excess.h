#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan.h"

/// Explains why a plan cannot begin in the start state of the car, for MakeFeasible.
namespace trackbed::start_excess {

/// Returns an excess of the position, and an excess of the heading, if the path does not begin at
/// the pose of the car. For a rolling car, also returns an excess of the start steering if it
/// differs from the steering angle with which the path begins. If the car cannot steer the start of
/// the path at all, returns no excess of the start steering, because the excess of the steering
/// angle is the cause. The hints of the excesses give the start values that fit the path.
std::vector<Excess> At(const Plan& plan, const PlanRequest& request);

/// Returns the excess of a start speed above `highest`, the highest feasible start speed [m/s].
/// `cause` is the limit that the car exceeds, and `station` is the place of the excess [m].
Excess TooFast(double start_speed, double highest, const std::string& cause, double station);

/// Returns the excess over a limit that remains even if the car brakes from its start as hard as it
/// can. Returns nullopt if braking is hard enough for all limits of steering rate, speed and
/// lateral acceleration.
std::optional<Excess> LeftAfterBraking(const Plan& plan, const PlanRequest& request);

/// Returns the highest start speed from 0 to `start_speed` [m/s] for which `is_feasible` returns
/// true, with an error of 0.4 % of `start_speed`. Returns nullopt if not even a car at rest is
/// feasible. Assumes that all speeds below a feasible start speed are feasible.
template <typename IsFeasible>
std::optional<double> HighestStartSpeed(double start_speed, const IsFeasible& is_feasible) {
  if (!(start_speed > 0.0) || !is_feasible(0.0)) {
    return std::nullopt;
  }
  constexpr int kBisections = 8;
  double low = 0.0;
  double high = start_speed;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (is_feasible(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace trackbed::start_excess
