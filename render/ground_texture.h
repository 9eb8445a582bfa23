#pragma once

#include <mujoco/mujoco.h>

namespace trackbed::render {

/// Replaces the texture of a model's ground, its geom `ground`, by a plain surface: grain, so that
/// motion over it is visible, and with `lines` a fine line every 5 m. Keeps the mean color. Does
/// nothing if the ground has no 2-D texture. Must be called before the model's Offscreen is made.
void MakeGroundPlain(mjModel& model, bool lines);

}  // namespace trackbed::render
