#include "src/drive/slip_control.h"

#include <algorithm>
#include <cmath>

namespace trackbed {

double EaseForSlip(double acceleration, const VehicleState& state) {
  constexpr double kSlipOfNoReduction = 0.15;
  constexpr double kSlipOfFullReduction = 0.35;
  constexpr double kMinSpeed = 2.0;  // [m/s]
  if (!state.wheels || std::abs(state.speed) < kMinSpeed) {
    return acceleration;
  }
  double slip = 0.0;
  for (const WheelState& wheel : *state.wheels) {
    slip = std::max(slip, std::copysign(1.0, acceleration) * wheel.slip_ratio);
  }
  return acceleration *
         std::clamp((kSlipOfFullReduction - slip) / (kSlipOfFullReduction - kSlipOfNoReduction),
                    0.0, 1.0);
}

}  // namespace trackbed
