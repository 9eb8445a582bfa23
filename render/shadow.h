#pragma once

#include <mujoco/mujoco.h>

#include "render/camera.h"

/// MuJoCo's shadow map is one square picture of the scene from a lamp, with a size set by the model
/// and centered at the lamp. Objects outside it cast no shadow. These functions center the square
/// on the area that the camera sees.
namespace trackbed::render {

/// Half side of the shadow map [m]. For a camera from above it covers everything visible. For one
/// that sees the horizon it is limited, so that a pixel at the camera's target has 1.6 texels in a
/// picture with 720 rows: 18 m for the chase camera, 9 m for the side camera.
double ShadowReach(const CameraPose& camera);

/// Sizes the shadow map for a camera, whose distance and lens must stay the same in the film. Must
/// be called before the Offscreen is made.
void FitShadowMap(mjModel& model, const CameraPose& camera);

/// Moves the directional lamps that cast shadows so that the map covers the area the camera sees.
/// Their light does not change.
void AimLamps(mjvScene& scene, const CameraPose& camera);

}  // namespace trackbed::render
