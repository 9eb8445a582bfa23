#pragma once

#include "trackbed/vehicle/state.h"

namespace trackbed {

/// The wanted `acceleration` [m/s^2], positive forward, also of a car that goes backward; less
/// where a wheel slips: whole up to a slip ratio of 0.15 in the direction of the acceleration, none
/// from 0.35 on, linear in between, as a driver or an anti-lock brake eases off. Tyres give the
/// most at about 0.1; past it a wheel soon locks or spins and, under a command that stays, does not
/// recover. Unchanged below 2 m/s, where slip ratios tell nothing, and for a car whose wheels are
/// not known.
double EaseForSlip(double acceleration, const VehicleState& state);

}  // namespace trackbed
