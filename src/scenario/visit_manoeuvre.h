#pragma once

#include "trackbed/options/key_visitor.h"
#include "trackbed/scenario/manoeuvre.h"

/// The keys of the maneuvers.
namespace trackbed {

/// Of the maneuvers that fit gradients.
template <typename Options>
void VisitGradients(KeyVisitor& a, Options& options) {
  a.Field({"settle", "s", "samples count after it"}, options.settle, Need::kOptional, kNonNegative);
  a.Field({"fit_from", "m/s^2", "gradients are fitted from this lateral acceleration"},
          options.fit_from, Need::kOptional, kNonNegative);
  a.Field({"fit_to", "m/s^2", "up to this one"}, options.fit_to, Need::kOptional, kPositive);
}

inline void Visit(KeyVisitor& a, SteadyStateCircleOptions& options) {
  VisitGradients(a, options);
}

inline void Visit(KeyVisitor& a, SlowlyIncreasingSteerOptions& options) {
  VisitGradients(a, options);
}

inline void Visit(KeyVisitor& a, StepSteerOptions& options) {
  a.Field({"steady", "s", "the steady state is the mean over the last so many seconds"},
          options.steady, Need::kOptional, kPositive);
}

inline void Visit(KeyVisitor&, SineWithDwellTestOptions&) {}

inline void Visit(KeyVisitor&, LaneChangeOptions&) {}

inline void Visit(KeyVisitor& a, BrakingTestOptions& options) {
  a.Field({"to_speed", "m/s", "the braking distance ends here"}, options.to_speed, Need::kOptional,
          kNonNegative);
}

inline void Visit(KeyVisitor& a, DisturbanceOptions& options) {
  a.Field({"at", "s", "the course held then is what is departed from"}, options.at, Need::kOptional,
          kNonNegative);
  a.Field({"yaw_rate_bound", "rad/s", "below it for good, the car has recovered"},
          options.yaw_rate_bound, Need::kOptional, kPositive);
}

}  // namespace trackbed
