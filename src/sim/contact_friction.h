#pragma once

#include <mujoco/mujoco.h>

namespace trackbed {

/// The friction coefficient of MuJoCo's contact between a tyre and the ground, as MuJoCo combines
/// theirs: the higher priority's, else the larger. `tyre` is a geom.
double ContactFriction(const mjModel& model, int tyre);

}  // namespace trackbed
