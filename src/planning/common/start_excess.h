#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan.h"

/// Explains why a plan cannot begin in the start state of the car, for MakeFeasible.
namespace trackbed::start_excess {

/// Returns the differences between the car's start pose and the start of the path, as excesses of
/// position and heading. For a rolling car, the result includes the difference between the car's
/// steering angle and the path's first steering angle. If the path's first steering angle exceeds
/// the car's limit, the start steering is not reported, because the angle limit is the cause. Each
/// excess has a hint with the start value that fits the path.
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
