#include "trackbed/vehicle/steering_faults.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {

namespace {

/// Returns the number of timesteps by which a ring buffer delays the steering command.
std::size_t StepsOf(const SteeringFaults& faults, double timestep, double start) {
  TRACKBED_REQUIRE(std::isfinite(faults.factor) && faults.backlash >= 0.0 &&
                       std::isfinite(faults.backlash) && std::isfinite(start),
                   "FaultySteering: factor {}, backlash {} rad, start {} rad; must be finite",
                   faults.factor, faults.backlash, start);
  constexpr double kMaxSteps = 1e7;
  const double steps = faults.delay / timestep;
  TRACKBED_REQUIRE(timestep > 0.0 && faults.delay >= 0.0 && steps <= kMaxSteps,
                   "FaultySteering: a delay of {} s in timesteps of {} s; must be at most {} steps",
                   faults.delay, timestep, kMaxSteps);
  return static_cast<std::size_t>(std::lround(steps));
}

}  // namespace

FaultySteering::FaultySteering(const SteeringFaults& faults, double timestep, double start)
    : faults_(faults), delay_line_(StepsOf(faults, timestep, start), start), output_(start) {}

double FaultySteering::Pass(double wanted) {
  TRACKBED_REQUIRE(std::isfinite(wanted), "FaultySteering::Pass: {} rad; must be finite", wanted);
  double arrived = faults_.factor * wanted;
  if (!delay_line_.empty()) {
    std::swap(arrived, delay_line_[oldest_]);
    oldest_ = (oldest_ + 1) % delay_line_.size();
  }
  const double play = 0.5 * faults_.backlash;
  output_ = std::clamp(output_, arrived - play, arrived + play);
  return output_;
}

}  // namespace trackbed
