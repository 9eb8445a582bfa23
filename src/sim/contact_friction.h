#pragma once

#include <mujoco/mujoco.h>

namespace trackbed {

/// Returns the friction coefficient of MuJoCo's contact between a tyre and the ground. As in
/// MuJoCo, the geom with the higher priority determines the coefficient. If the priorities of both
/// geoms are equal, the larger of their two coefficients is used. `tyre` is the index of the tyre's
/// geom.
double ContactFriction(const mjModel& model, int tyre);

}  // namespace trackbed
