#pragma once

#include <mujoco/mujoco.h>

namespace trackbed::render {

/// Gives the ground of a model, its geom `ground`, a plain surface in place of its texture: grain,
/// so that motion over it is seen, and where `lines` a fine line every 5 m. Its mean color stays.
/// Nothing where the ground has no 2-D texture. Before the model's Offscreen is made.
void MakeGroundPlain(mjModel& model, bool lines);

}  // namespace trackbed::render
