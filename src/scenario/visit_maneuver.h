#pragma once

#include "trackbed/options/key_visitor.h"
#include "trackbed/scenario/maneuver.h"

/// Functions Visit that declare the keys of the maneuvers in a scenario.
namespace trackbed {

/// Visits the keys that are common to all maneuvers in which gradients, such as the understeer
/// gradient, are measured.
template <typename Options>
void VisitGradients(KeyVisitor& a, Options& options) {
  a.Field({"settle", "s", "samples before this time are ignored"}, options.settle, Need::kOptional,
          kNonNegative);
  a.Field({"fit_from", "m/s^2", "lower end of the lateral acceleration range of the gradient fit"},
          options.fit_from, Need::kOptional, kNonNegative);
  a.Field({"fit_to", "m/s^2", "upper end of that range"}, options.fit_to, Need::kOptional,
          kPositive);
}

inline void Visit(KeyVisitor& a, SteadyStateCircleOptions& options) {
  VisitGradients(a, options);
}

inline void Visit(KeyVisitor& a, SlowlyIncreasingSteerOptions& options) {
  VisitGradients(a, options);
}

inline void Visit(KeyVisitor& a, StepSteerOptions& options) {
  a.Field({"steady", "s", "averaging window of the steady state, at the end of the run"},
          options.steady, Need::kOptional, kPositive);
}

inline void Visit(KeyVisitor&, SineWithDwellTestOptions&) {}

inline void Visit(KeyVisitor&, LaneChangeOptions&) {}

inline void Visit(KeyVisitor& a, BrakingTestOptions& options) {
  a.Field({"to_speed", "m/s", "final speed of the braking distance"}, options.to_speed,
          Need::kOptional, kNonNegative);
}

inline void Visit(KeyVisitor& a, DisturbanceOptions& options) {
  a.Field(
      {"at", "s", "time of the disturbance; deviations are measured from the course at this time"},
      options.at, Need::kOptional, kNonNegative);
  a.Field({"yaw_rate_bound", "rad/s", "the car has recovered once the yaw rate stays below this"},
          options.yaw_rate_bound, Need::kOptional, kPositive);
}

}  // namespace trackbed
