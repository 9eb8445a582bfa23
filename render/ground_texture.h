#pragma once

#include <mujoco/mujoco.h>

namespace trackbed::render {

/// Replaces the texture of a model's ground, its geom `ground`, by a plain surface. Grain makes
/// motion over the surface visible; `lines` adds a fine line every 5 m. The new ground texture
/// keeps the mean color. MakeGroundPlain does nothing if the ground has no 2-D texture. Call
/// MakeGroundPlain before making the model's Offscreen.
void MakeGroundPlain(mjModel& model, bool lines);

}  // namespace trackbed::render
