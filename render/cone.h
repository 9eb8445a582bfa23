#pragma once

#include <mujoco/mujoco.h>

#include "render/recording.h"

namespace trackbed::render {

/// Number of cylinders that form a traffic cone, since MuJoCo has no cone shape.
inline constexpr std::size_t kConePieces = 4;

/// Adds a traffic cone, half a meter high, that stands at `foot`. AddCone does nothing if the scene
/// is full.
void AddCone(mjvScene& scene, const Point& foot);

}  // namespace trackbed::render
