#pragma once

#include "trackbed/sim/car_model.h"

namespace trackbed {

struct Traction {
  double force = 0.0;      ///< maximum, less the rolling resistance [N]
  double power = 0.0;      ///< maximum [W]; 0: not limited
  double rolling = 0.0;    ///< rolling resistance and bearings [N]
  double drag_area = 0.0;  ///< C_d A [m^2]
};

/// The speed [m/s] at which traction, min(force, power/v - rolling), equals the drag in still air;
/// 0 when there is no such speed.
double TopSpeed(const Traction& traction);

}  // namespace trackbed
