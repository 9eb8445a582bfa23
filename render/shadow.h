#pragma once

#include <mujoco/mujoco.h>

#include "render/camera.h"

/// MuJoCo's shadow map is one square picture of the scene from a lamp. The model sets its size, and
/// the lamp is its center. Objects outside the square cast no shadow. The functions in this file
/// center the shadow map on the area that the camera sees.
namespace trackbed::render {

/// Half side of the shadow map [m]. For a camera from above, the shadow map covers everything
/// visible. For a camera that sees the horizon, the map is limited. In a picture with 720 rows, a
/// pixel at the camera's target then has 1.6 texels of the shadow map. The half side is 18 m for
/// the chase camera and 9 m for the side camera.
double ShadowReach(const CameraPose& camera);

/// Sizes the shadow map for a camera, whose distance and lens must stay the same during the film.
/// Call FitShadowMap before making the Offscreen.
void FitShadowMap(mjModel& model, const CameraPose& camera);

/// Moves the directional lamps that cast shadows so that the map covers the area the camera sees.
/// Moving a directional lamp does not change its light.
void AimLamps(mjvScene& scene, const CameraPose& camera);

}  // namespace trackbed::render
