#include "trackbed/vehicle/steering_faults.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trackbed {

FaultySteering::FaultySteering(const SteeringFaults& faults, double timestep, double start)
    : faults_(faults),
      on_the_way_(static_cast<std::size_t>(std::lround(faults.delay / timestep)), start),
      given_(start) {}

double FaultySteering::Pass(double wanted) {
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
