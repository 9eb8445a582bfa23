#pragma once

#include "trackbed/sim/car_model.h"

namespace trackbed {

struct Traction {
  double force = 0.0;      ///< Maximum force, less the rolling resistance [N].
  double power = 0.0;      ///< Maximum power [W]; 0: not limited.
  double rolling = 0.0;    ///< Resistance of rolling and bearings [N].
  double drag_area = 0.0;  ///< Drag area C_d A [m^2].
};

/// The speed at which traction equals the drag in still air [m/s]. Traction is min(force, power/v -
/// rolling); the top speed is 0 if traction and drag are never equal.
double TopSpeed(const Traction& traction);

}  // namespace trackbed
