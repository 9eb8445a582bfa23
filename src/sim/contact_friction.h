#pragma once

#include <mujoco/mujoco.h>

namespace trackbed {

/// The friction coefficient of MuJoCo's contact between a tyre and the ground. As in MuJoCo, the
/// geom of the higher priority determines the coefficient. For equal priorities, the friction is
/// the larger coefficient. `tyre` is the index of a geom.
double ContactFriction(const mjModel& model, int tyre);

}  // namespace trackbed
