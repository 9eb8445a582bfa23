#pragma once

#include "trackbed/vehicle/state.h"

namespace trackbed {

/// Reduces the wanted `acceleration` [m/s^2], positive forward in either gear, if a wheel slips:
/// unchanged up to a slip ratio of 0.15 in the direction of the acceleration, zero from 0.35,
/// linear in between, as a driver or an anti-lock brake eases off. The force of tyres peaks at a
/// slip ratio of about 0.1; beyond it, a wheel soon locks or spins and does not recover under a
/// constant command. Unchanged below 2 m/s, where slip ratios are meaningless, and for cars without
/// wheel states.
double EaseForSlip(double acceleration, const VehicleState& state);

}  // namespace trackbed
