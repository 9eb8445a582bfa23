#pragma once

#include <mujoco/mujoco.h>

#include "render/camera.h"

/// MuJoCo's shadow map is one square picture of the scene as a lamp sees it, as large as the model
/// says and around the lamp. What lies outside casts no shadow. Here the square lies over what the
/// camera sees.
namespace trackbed::render {

/// How far the shadow map reaches from its middle to each side [m]: over all that a camera from
/// above sees; where one sees as far as the horizon, as far as a texel at the camera's target is
/// 1.2 pixels of a picture with 720 rows: 38 m for the chase camera, 18 m for the side camera.
double ShadowReach(const CameraPose& camera);

/// Sizes the shadow map for a camera, whose distance and lens the film must keep. Before the
/// Offscreen is made.
void FitShadowMap(mjModel& model, const CameraPose& camera);

/// Moves the lamps that shine in one direction and cast shadows so that the map lies over what the
/// camera sees. Their light stays as it is.
void AimLamps(mjvScene& scene, const CameraPose& camera);

}  // namespace trackbed::render
