#include "render/shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "render/mujoco_compat.h"

namespace trackbed::render {
namespace {

// side of the square shadow map [texels]; a side of 8192 would take a quarter of a frame's
// rendering time
constexpr int kShadowMapSide = 4096;

}  // namespace

double ShadowReach(const CameraPose& camera) {
  const double half_height = camera.distance * std::tan(0.5 * camera.view_angle);
  // If the shadow map reaches 3.5 half heights of the frame to each side, the side of the shadow
  // map is 7 half heights. With a side of 7 half heights of the frame, the shadow map's 4096 texels
  // yield 1.6 texels per pixel of a frame with 720 rows.
  constexpr double kMaxHalfHeights = 3.5;
  // Half the diagonal of a frame with an aspect ratio of up to 21:9, in half heights of the frame;
  // used for a camera that looks down.
  const double seen = 2.5 / std::max(0.1, std::sin(-camera.elevation));
  return half_height * std::min(kMaxHalfHeights, seen);
}

void FitShadowMap(mjModel& model, const CameraPose& camera) {
  model.vis.map.shadowclip = static_cast<float>(ShadowReach(camera) / model.stat.extent);
  model.vis.quality.shadowsize = kShadowMapSide;
}

void AimLamps(mjvScene& scene, const CameraPose& camera) {
  const double reach = ShadowReach(camera);
  // The shadow map is centered beyond the camera's target, since little ground is visible between
  // camera and target.
  const double ahead = 0.6 * reach * std::cos(camera.elevation);
  // The shadow map moves in steps, so that its texels stay in place between two steps. Moving the
  // shadow map in steps keeps the edges of static shadows from flickering.
  const double step = 0.1 * reach;
  const auto in_steps = [step](double place) { return step * std::round(place / step); };
  const std::array<double, 3> middle{in_steps(camera.target_x + ahead * std::cos(camera.azimuth)),
                                     in_steps(camera.target_y + ahead * std::sin(camera.azimuth)),
                                     camera.ground_z};
  // The lamp is placed so far away that all ground in the shadow map is in front of the lamp, if
  // the lamp's elevation is at least 20 degrees.
  const double back = 3.0 * reach;
  for (int i = 0; i < scene.nlight; ++i) {
    mjvLight& lamp = scene.lights[i];
    if (!mj::IsDirectional(lamp) || lamp.castshadow == 0) {
      continue;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lamp.pos[axis] =
          static_cast<float>(middle[axis] - back * static_cast<double>(lamp.dir[axis]));
    }
  }
}

}  // namespace trackbed::render
