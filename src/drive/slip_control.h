#pragma once

#include "trackbed/vehicle/state.h"

namespace trackbed {

/// Reduces the wanted `acceleration` [m/s^2] if a wheel slips, as a driver or an anti-lock brake
/// does. The wanted acceleration is positive in the forward direction of the car, in both gears.
/// The wanted acceleration is multiplied by a factor that is 1 up to a slip ratio of 0.15 and
/// decreases linearly to 0 at 0.35. The slip ratio is positive in the direction of the
/// acceleration. The bounds 0.15 and 0.35 are chosen because tyre forces peak at a slip ratio of
/// about 0.1. Beyond a slip ratio of 0.1, a wheel soon locks or spins and does not recover under a
/// constant command. The acceleration is not reduced at speeds below 2 m/s, where slip ratios are
/// meaningless, or for cars without wheel states.
double EaseForSlip(double acceleration, const VehicleState& state);

}  // namespace trackbed
