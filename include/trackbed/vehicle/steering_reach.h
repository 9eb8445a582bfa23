#pragma once

#include "trackbed/vehicle/params.h"

/// Computes how far the steering actuator can turn the wheels of a car.
namespace trackbed {

/// Returns the largest steering angle [rad] > 0 that the wheels can hold to the left (`side` > 0),
/// to the right (`side` < 0), or to both sides (`side` = 0). SteeringReach returns the smaller one
/// of two angles: the steering limit, and the end of the steering curve minus half of the backlash.
/// The backlash is subtracted because wheels that turn from straight ahead stop at the near edge of
/// the play. SteeringReach ignores a steering curve with which the wheels can turn to one side
/// only.
[[nodiscard]] double SteeringReach(const VehicleParams& params, double side);

}  // namespace trackbed
