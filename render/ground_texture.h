#pragma once

#include <mujoco/mujoco.h>

namespace trackbed::render {

/// Replaces the texture of the model's geom `ground` by a plain, grainy surface. The grainy texture
/// makes motion over the ground visible. If `lines` is true, the texture also has a fine line every
/// 5 m. The new texture keeps the mean color of the old one. MakeGroundPlain does nothing if the
/// geom has no 2-D texture. Call MakeGroundPlain before constructing the Offscreen of the model.
void MakeGroundPlain(mjModel& model, bool lines);

}  // namespace trackbed::render
