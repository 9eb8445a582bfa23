#pragma once

#include "trackbed/sim/car_model.h"

namespace trackbed {

struct Traction {
  double force = 0.0;      ///< Maximum drive force of the vehicle minus the rolling resistance [N].
  double power = 0.0;      ///< Maximum drive power [W]; 0 means that the power is not limited.
  double rolling = 0.0;    ///< Resistance of the rolling tyres and the bearings [N].
  double drag_area = 0.0;  ///< Drag area C_d A of the vehicle [m^2].
};

/// Returns the top speed of the vehicle, at which the traction equals the drag in still air [m/s].
/// The traction at speed v is min(force, power/v - rolling), with the maximum drive force, the
/// drive power and the rolling resistance. Returns 0 if the top speed is unlimited.
double TopSpeed(const Traction& traction);

}  // namespace trackbed
