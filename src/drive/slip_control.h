#pragma once

#include "trackbed/vehicle/state.h"

namespace trackbed {

/// Reduces the wanted `acceleration` if a wheel slips, as a driver or an anti-lock brake does
/// [m/s^2]. The acceleration is positive forward in either gear. The acceleration stays unchanged
/// up to a slip ratio of 0.15 in its direction, is zero from 0.35, and linear in between. The force
/// of tyres peaks at a slip ratio of about 0.1. Beyond a slip ratio of about 0.1, a wheel soon
/// locks or spins and does not recover under a constant command. The acceleration stays unchanged
/// below 2 m/s, where slip ratios are meaningless, and for cars without wheel states.
double EaseForSlip(double acceleration, const VehicleState& state);

}  // namespace trackbed
