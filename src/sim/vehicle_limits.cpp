#include "src/sim/vehicle_limits.h"

#include <algorithm>
#include <cmath>

namespace trackbed {

double TopSpeed(const Traction& traction) {
  const double drag = 0.5 * kAirDensity * traction.drag_area;
  // Speed at which the drag equals the maximum force [m/s]; infinite if there is no drag.
  const double by_force = std::sqrt(std::max(0.0, traction.force) / drag);
  if (traction.power <= 0.0) {
    return std::isfinite(by_force) ? by_force : 0.0;
  }
  // Power that remains after overcoming the driving resistance at speed v [W]; decreases as v
  // increases.
  const auto spare = [&](double v) {
    return traction.power - (traction.rolling + drag * v * v) * v;
  };
  double low = 0.0;
  double high = 1.0;
  while (spare(high) > 0.0) {
    high *= 2.0;
    if (!std::isfinite(high)) {
      return 0.0;
    }
  }
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) {
      return std::min(low, by_force);
    }
    (spare(middle) > 0.0 ? low : high) = middle;
  }
}

}  // namespace trackbed
