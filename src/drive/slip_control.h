#pragma once

#include "trackbed/vehicle/state.h"

namespace trackbed {

/// Reduces the wanted `acceleration` [m/s^2] if a wheel slips, as a driver or an anti-lock brake
/// does. The acceleration is positive forward in either gear. The factor of reduction is 1 up to a
/// slip ratio of 0.15 in the direction of the acceleration, falls linearly, and is 0 from a slip
/// ratio of 0.35. The reason: tyre forces peak at a slip ratio of about 0.1. Beyond this ratio, a
/// wheel soon locks or spins and does not recover under a constant command. The acceleration is not
/// reduced below 2 m/s, where slip ratios are meaningless, or for cars without wheel states.
double EaseForSlip(double acceleration, const VehicleState& state);

}  // namespace trackbed
