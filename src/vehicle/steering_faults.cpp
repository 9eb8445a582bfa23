#include "trackbed/vehicle/steering_faults.h"

#include <algorithm>
#include <cmath>

namespace trackbed {

FaultySteering::FaultySteering(const SteeringFaults& faults, double timestep, double start)
    : faults_(faults),
      on_the_way_(static_cast<std::size_t>(std::lround(faults.delay / timestep)), start),
      given_(start) {}

double FaultySteering::Pass(double wanted) {
  on_the_way_.push_back(faults_.factor * wanted);
  const double arrived = on_the_way_.front();
  on_the_way_.pop_front();
  const double play = 0.5 * faults_.backlash;
  given_ = std::clamp(given_, arrived - play, arrived + play);
  return given_;
}

}  // namespace trackbed
