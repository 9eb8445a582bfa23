#include "render/ghost.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/ground_line.h"
#include "render/mujoco_compat.h"
#include "render/scene_handle.h"
#include "render/trail.h"
#include "trackbed/sim/mujoco_handles.h"

namespace trackbed::render {
namespace {

// alpha value of a ghost; MuJoCo draws translucent surfaces twice, so the opacity is 1 - 0.78^2 =
// 0.39
constexpr float kGhostAlpha = 0.22F;
constexpr float kGhostTint = 0.7F;
// A part of a ghost is not drawn if its size is below this fraction of the ghost's largest part.
// Small parts such as spokes and lamps are not recognizable in a ghost, and drawing them would
// triple the rendering time.
constexpr float kGhostDetail = 0.125F;
// Distance by which a ghost is drawn farther from the camera than its true position [m]. Drawing a
// ghost farther away lets the car hide a coinciding ghost, which would otherwise flicker on the
// car's surface. Differences between car and ghost below kGhostBehind are visible only by the
// ghost's footprint and trail.
constexpr double kGhostBehind = 0.10;
constexpr double kFootprintWidth = 0.06;  // Width of the lines of a ghost's footprint [m].
// Maximum number of pieces in the outline of a footprint; enough for pieces of 0.25 m around a car
// of 8 m by 3 m.
constexpr std::size_t kFootprintMax = 100;

float LargestSide(const mjvGeom& geom) {
  return std::max({geom.size[0], geom.size[1], geom.size[2]});
}

void MakeTranslucent(mjvGeom& geom, const Color& color) {
  const std::array<float, 3> tint{color.r, color.g, color.b};
  for (std::size_t i = 0; i < 3; ++i) {
    geom.rgba[i] = (1.0F - kGhostTint) * geom.rgba[i] + kGhostTint * tint[i];
  }
  geom.rgba[3] = kGhostAlpha;
  geom.emission = 0.3F;
  geom.specular *= 0.3F;
  geom.reflectance = 0.0F;
  mj::RemoveTexture(geom);
}

class Ghosts : public Overlay {
 public:
  explicit Ghosts(const OverlaySetup& setup)
      : recording_(setup.recording),
        data_(MakeMujocoData(*recording_.model)),
        posed_(*recording_.model, 2 * recording_.model->ngeom + 100) {}

  [[nodiscard]] std::size_t max_shapes() const override {
    const auto of_one = static_cast<std::size_t>(2 * recording_.model->ngeom + 100);
    return (recording_.plants.size() - 1) * (of_one + kFootprintMax);
  }

  void AddShapes(SceneContext& context) override {
    for (std::size_t car = 1; car < recording_.plants.size(); ++car) {
      AddGhost(context, car);
    }
  }

  void AddLegend(std::vector<LegendEntry>& legend) const override {
    for (std::size_t car = 1; car < recording_.plants.size(); ++car) {
      const PlantRecording& plant = recording_.plants[car];
      legend.push_back(
          {plant.color(), plant.plant() + " (ghost)", "at equal time, with footprint"});
    }
  }

 private:
  void AddGhost(SceneContext& context, std::size_t car) {
    const mjModel& model = *recording_.model;
    mjvScene& ghost = posed_.get();
    mjvScene& scene = context.scene;
    recording_.plants[car].Pose(context.time, model, *data_);
    if (context.camera.inside && BlocksCamera(context.time, car)) {
      return;
    }
    mjv_updateScene(&model, data_.get(), &context.visible, nullptr, &context.view, mjCAT_DYNAMIC,
                    &ghost);
    const auto behind = static_cast<float>(kGhostBehind / context.camera.distance);
    float largest = 0.0F;
    for (int i = 0; i < ghost.ngeom; ++i) {
      largest = std::max(largest, LargestSide(ghost.geoms[i]));
    }
    for (int i = 0; i < ghost.ngeom && scene.ngeom < scene.maxgeom; ++i) {
      if (LargestSide(ghost.geoms[i]) < kGhostDetail * largest) {
        continue;
      }
      mjvGeom& geom = scene.geoms[scene.ngeom];
      geom = ghost.geoms[i];
      MakeTranslucent(geom, recording_.plants[car].color());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float eye = scene.camera[0].pos[axis];
        geom.pos[axis] += behind * (geom.pos[axis] - eye);
      }
      ++scene.ngeom;
    }
    RibbonStyle style = TrailStyle(recording_, car, context.camera.paint_scale);
    style.width = kFootprintWidth * context.camera.paint_scale;
    AddFootprint(context, style);
  }

  /// Whether a ghost is so close that it would hide the road from a camera inside the car.
  [[nodiscard]] bool BlocksCamera(double time, std::size_t ghost) const {
    const Point own = recording_.plants.front().Position(time);
    const Point other = recording_.plants[ghost].Position(time);
    return std::hypot(other.x - own.x, other.y - own.y) <
           2.0 * FindCarBox(*recording_.model).half_length;
  }

  void AddFootprint(SceneContext& context, const RibbonStyle& style) const {
    const mjModel& model = *recording_.model;
    const int site = mj_name2id(&model, mjOBJ_SITE, "footprint");
    if (site < 0 || model.site_type[site] != mjGEOM_BOX) {
      return;
    }
    const mjtNum* center = data_->site_xpos + 3 * site;
    const mjtNum* rotation = data_->site_xmat + 9 * site;
    const mjtNum* size = model.site_size + 3 * site;
    const auto corner = [&](double forward, double left) {
      return Vec2(center[0] + rotation[0] * forward * size[0] + rotation[1] * left * size[1],
                  center[1] + rotation[3] * forward * size[0] + rotation[4] * left * size[1]);
    };
    AddLine(context, recording_.world,
            Outline(recording_, {corner(1, 1), corner(-1, 1), corner(-1, -1), corner(1, -1)}),
            style);
  }

  const Recording& recording_;
  MujocoData data_;
  SceneHandle posed_;
};

}  // namespace

OverlayEntry GhostOverlay() {
  return MakeOverlayEntry<Ghosts>("ghosts",
                                  "the other plants as translucent cars with their footprints");
}

}  // namespace trackbed::render
