#pragma once

#include <mujoco/mujoco.h>

#include "render/camera.h"
#include "render/recording.h"

namespace trackbed::render {

/// Most pieces that AddWindArrows adds.
inline constexpr int kMostWindPieces = 3 * 81;

/// Draws the wind at `time` [s] as arrows on the ground around where the camera looks, at places
/// that do not move with it. Each is as long as the air moves in a third of a second; where there
/// is next to no wind there is none.
void AddWindArrows(mjvScene& scene, const Recording& recording, double time,
                   const CameraPose& camera);

}  // namespace trackbed::render
