#pragma once

#include <mujoco/mujoco.h>

#include "render/recording.h"

namespace trackbed::render {

/// Shapes that one traffic cone is made of: MuJoCo's scenes have none.
inline constexpr std::size_t kConePieces = 4;

/// Draws a cone of half a meter that stands at `foot`. A scene that is full stays as it is.
void AddCone(mjvScene& scene, const Point& foot);

}  // namespace trackbed::render
