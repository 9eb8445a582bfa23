#include "trackbed/vehicle/steering_actuator.h"

#include <algorithm>
#include <cmath>

namespace trackbed {

SteeringMove MoveSteering(const SteeringLimits& limits, double start, double wanted) {
  const double end = std::clamp(wanted, -limits.angle, limits.angle);
  return {start, end, std::copysign(limits.rate, end - start), std::abs(end - start) / limits.rate};
}

}  // namespace trackbed
