#pragma once

#include "trackbed/sim/car_model.h"

namespace trackbed {

struct Traction {
  double force = 0.0;      ///< Maximum drive force minus the rolling resistance [N].
  double power = 0.0;      ///< Maximum drive power [W]; 0: not limited.
  double rolling = 0.0;    ///< Resistance of rolling tyres and bearings [N].
  double drag_area = 0.0;  ///< Drag area C_d A [m^2].
};

/// Returns the top speed, at which traction equals the drag in still air [m/s]. Traction is
/// min(force, power/v - rolling). Returns 0 if there is no such speed.
double TopSpeed(const Traction& traction);

}  // namespace trackbed
