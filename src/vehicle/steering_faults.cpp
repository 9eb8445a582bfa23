#include "trackbed/vehicle/steering_faults.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {

namespace {

/// Length of the delay's ring buffer.
std::size_t StepsOf(const SteeringFaults& faults, double timestep, double start) {
  TRACKBED_REQUIRE(std::isfinite(faults.factor) && faults.backlash >= 0.0 &&
                       std::isfinite(faults.backlash) && std::isfinite(start),
                   "FaultySteering: factor {}, backlash {} rad, start {} rad; must be finite",
                   faults.factor, faults.backlash, start);
  constexpr double kMostSteps = 1e7;
  const double steps = faults.delay / timestep;
  TRACKBED_REQUIRE(timestep > 0.0 && faults.delay >= 0.0 && steps <= kMostSteps,
                   "FaultySteering: a delay of {} s in timesteps of {} s; must be at most {} steps",
                   faults.delay, timestep, kMostSteps);
  return static_cast<std::size_t>(std::lround(steps));
}

}  // namespace

FaultySteering::FaultySteering(const SteeringFaults& faults, double timestep, double start)
    : faults_(faults), on_the_way_(StepsOf(faults, timestep, start), start), given_(start) {}

double FaultySteering::Pass(double wanted) {
  TRACKBED_REQUIRE(std::isfinite(wanted), "FaultySteering::Pass: {} rad; must be finite", wanted);
  double arrived = faults_.factor * wanted;
  if (!on_the_way_.empty()) {
    std::swap(arrived, on_the_way_[oldest_]);
    oldest_ = (oldest_ + 1) % on_the_way_.size();
  }
  const double play = 0.5 * faults_.backlash;
  given_ = std::clamp(given_, arrived - play, arrived + play);
  return given_;
}

}  // namespace trackbed
