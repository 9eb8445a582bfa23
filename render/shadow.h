#pragma once

#include <mujoco/mujoco.h>

#include "render/camera.h"

/// MuJoCo's shadow map is a square image of the scene as seen from a lamp. The model determines the
/// size of the shadow map, whose center is at the lamp. Objects outside the square of the shadow
/// map cast no shadow. The functions of shadow.h center the shadow map on the area that the camera
/// sees.
namespace trackbed::render {

/// Returns half the side of the shadow map [m]. For a camera that looks down from above, the shadow
/// map covers everything visible. For a camera that sees the horizon, the size of the shadow map is
/// limited. At its largest size, the shadow map has 1.6 texels per pixel at the camera's target, in
/// a frame with 720 rows. Half the side of the shadow map is 18 m for the chase camera and 9 m for
/// the side camera.
double ShadowReach(const CameraPose& camera);

/// Sets the size of the shadow map for a camera whose distance and lens do not change during the
/// film. Call FitShadowMap before constructing the Offscreen.
void FitShadowMap(mjModel& model, const CameraPose& camera);

/// Moves the directional lamps that cast shadows, so that the shadow map covers the area that the
/// camera sees. Moving a directional lamp does not change its light.
void AimLamps(mjvScene& scene, const CameraPose& camera);

}  // namespace trackbed::render
