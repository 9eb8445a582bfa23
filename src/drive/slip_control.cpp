#include "src/drive/slip_control.h"

#include <algorithm>
#include <cmath>

namespace trackbed {

double EaseForSlip(double acceleration, const VehicleState& state) {
  constexpr double kWhole = 0.15;
  constexpr double kNone = 0.35;
  constexpr double kSlowest = 2.0;  // [m/s]
  if (!state.wheels || std::abs(state.speed) < kSlowest) {
    return acceleration;
  }
  double slip = 0.0;
  for (const WheelState& wheel : *state.wheels) {
    slip = std::max(slip, std::copysign(1.0, acceleration) * wheel.slip_ratio);
  }
  return acceleration * std::clamp((kNone - slip) / (kNone - kWhole), 0.0, 1.0);
}

}  // namespace trackbed
