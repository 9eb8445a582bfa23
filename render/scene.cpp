#include "render/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "render/cone.h"
#include "render/decor.h"
#include "render/occlusion.h"
#include "render/shadow.h"
#include "trackbed/core/angle.h"

namespace trackbed::render {
namespace {

// Distance from the camera's target beyond which friction patches would be thinner than a pixel
// [m].
constexpr double kPaintRange = 250.0;

// factor that darkens the color of a plant on sunlit car bodies
constexpr float kPaintShade = 0.86F;

// depth by which height fields are lowered below their true height [m]
constexpr float kSunk = 0.002F;

// Several nested dark layers make a soft shadow under the car. Drawing the car's shadow with a
// shadow map would take half the rendering time of a frame.
constexpr int kShadowLayers = 6;
// Alpha value of one layer of the shadow; MuJoCo draws translucent shapes twice.
constexpr float kShadowAlpha = 0.055F;
// Distance by which each layer of the shadow is wider than the previous one [m].
constexpr double kShadowSpread = 0.09;
// Height of the shadow above the ground, higher than all paint [m].
constexpr double kShadowHeight = 0.03;

std::int64_t MaxGeoms(const Recording& recording, const std::vector<Tile>& patches,
                      const OverlayList& overlays) {
  std::size_t count = patches.size() + kConePieces * recording.cones.size() + kShadowLayers;
  for (const auto& overlay : overlays) {
    count += overlay->max_shapes();
  }
  // The maximum number of geoms in the scene allows for the model's geoms, the shapes that MuJoCo
  // adds, and the shapes of overlays.
  return 2 * recording.model->ngeom + 200 + static_cast<std::int64_t>(count);
}

/// Whether the camera sees anything other than the ground. If a camera sees only ground, the sky is
/// not drawn, which saves a third of the rendering time.
bool SeesSky(const mjModel& model, const World& world, const CameraPose& camera) {
  const int ground = mj_name2id(&model, mjOBJ_GEOM, "ground");
  const bool endless = ground >= 0 && model.geom_type[ground] == mjGEOM_PLANE &&
                       model.geom_size[3 * ground] == 0 && model.geom_size[3 * ground + 1] == 0;
  constexpr double kHaze = 0.1;  // Angular height of the haze below the horizon [rad].
  // Elevation angle of the horizon in the downhill direction [rad].
  const double horizon = -std::atan(world.ground.grade.norm());
  return !endless || camera.elevation + 0.5 * camera.view_angle > horizon - kHaze;
}

/// Lowers all height fields slightly. SinkHeightFields prevents flicker where a height field has
/// the height of the ground plane.
void SinkHeightFields(mjvScene& scene) {
  for (int i = 0; i < scene.ngeom; ++i) {
    if (scene.geoms[i].type == mjGEOM_HFIELD) {
      scene.geoms[i].pos[2] -= kSunk;
    }
  }
}

}  // namespace

std::vector<CarPart> FindCarParts(const mjModel& model) {
  const int chassis = model.jnt_bodyid[mj_name2id(&model, mjOBJ_JOINT, "chassis")];
  std::vector<CarPart> parts(static_cast<std::size_t>(model.ngeom));
  for (int i = 0; i < model.ngeom; ++i) {
    CarPart& part = parts[static_cast<std::size_t>(i)];
    part.of_car = model.body_rootid[model.geom_bodyid[i]] == model.body_rootid[chassis];
    if (part.of_car) {
      const int material = model.geom_matid[i];
      const char* name = material < 0 ? nullptr : mj_id2name(&model, mjOBJ_MATERIAL, material);
      part.painted = name != nullptr && std::string_view(name) == "paint";
    }
  }
  return parts;
}

FilmScene::FilmScene(Recording& recording, const OverlayList& overlays, bool shadows)
    : recording_(recording),
      overlays_(overlays),
      patches_(PatchTiles(recording.world)),
      box_(FindCarBox(*recording.model)),
      car_parts_(FindCarParts(*recording.model)),
      obstacle_geoms_(ObstacleGeoms(recording)),
      car_data_(MakeMujocoData(*recording.model)),
      scene_(*recording.model, MaxGeoms(recording, patches_, overlays)) {
  mjv_defaultOption(&visible_);
  std::fill(std::begin(visible_.sitegroup), std::end(visible_.sitegroup), mjtByte{0});
  mjv_defaultFreeCamera(recording.model.get(), &camera_);
  scene_.get().flags[mjRND_SHADOW] = shadows ? 1 : 0;
  scene_.get().flags[mjRND_REFLECTION] = 0;
}

mjvScene& FilmScene::At(double time, const CameraPose& camera) {
  mjModel& model = *recording_.model;
  mjvScene& scene = scene_.get();
  Aim(camera);
  recording_.plants.front().Pose(time, model, *car_data_);
  mjv_updateScene(&model, car_data_.get(), &visible_, nullptr, &camera_, mjCAT_ALL, &scene);
  SinkHeightFields(scene);
  for (int i = 0; i < scene.ngeom; ++i) {
    if (scene.geoms[i].type == mjGEOM_PLANE) {
      // geoms of the category mjCAT_DECOR cast no shadow, so the ground plane does not shade itself
      scene.geoms[i].category = mjCAT_DECOR;
    }
  }
  FadeOccluders(time, camera);
  if (camera.inside) {
    HideCar();
  } else {
    PaintCar();
  }
  scene.flags[mjRND_SKYBOX] = SeesSky(model, recording_.world, camera) ? 1 : 0;
  AimLamps(scene, camera);
  AddPatches(camera);
  for (const Point& cone : recording_.cones) {
    AddCone(scene, cone);
  }
  if (scene.flags[mjRND_SHADOW] == 0 && !camera.inside) {
    AddContactShadow();
  }
  SceneContext context{scene, time, camera, camera_, visible_};
  for (const auto& overlay : overlays_) {
    overlay->AddShapes(context);
  }
  return scene;
}

void FilmScene::Aim(const CameraPose& camera) {
  mjModel& model = *recording_.model;
  camera_.lookat[0] = camera.target_x;
  camera_.lookat[1] = camera.target_y;
  camera_.lookat[2] = camera.target_z;
  camera_.distance = camera.distance;
  camera_.azimuth = camera.azimuth * 180.0 / kPi;
  camera_.elevation = camera.elevation * 180.0 / kPi;
  model.vis.global.fovy = static_cast<float>(camera.view_angle * 180.0 / kPi);
  // The near clipping plane is as far from the camera as the car allows, because a larger distance
  // improves the resolution of the depth buffer.
  model.vis.map.znear = static_cast<float>(0.1 * camera.distance / model.stat.extent);
  model.vis.map.zfar = static_cast<float>((1000.0 + 2.0 * camera.distance) / model.stat.extent);
}

void FilmScene::FadeOccluders(double time, const CameraPose& camera) {
  const PlantRecording& car = recording_.plants.front();
  const Point place = recording_.OnGround(car.Position(time));
  const Pose2 pose{place.x, place.y, car.Heading(time)};
  const mjModel& model = *recording_.model;
  mjvScene& scene = scene_.get();
  for (int i = 0; i < scene.ngeom; ++i) {
    mjvGeom& geom = scene.geoms[i];
    if (geom.objtype != mjOBJ_GEOM || geom.type != mjGEOM_BOX ||
        std::find(obstacle_geoms_.begin(), obstacle_geoms_.end(), geom.objid) ==
            obstacle_geoms_.end()) {
      continue;
    }
    const mjtNum* center = car_data_->geom_xpos + 3 * geom.objid;
    const mjtNum* axes = car_data_->geom_xmat + 9 * geom.objid;
    const mjtNum* half = model.geom_size + 3 * geom.objid;
    const UprightBox box{
        {{center[0], center[1], std::atan2(axes[3], axes[0])}, 2.0 * half[0], 2.0 * half[1]},
        center[2] - half[2],
        center[2] + half[2]};
    geom.rgba[3] *= static_cast<float>(FadedAlpha(HiddenShare(box, camera, box_, pose, place.z)));
  }
}

void FilmScene::HideCar() {
  RemoveGeoms(scene_.get(), [this](const mjvGeom& geom) {
    return geom.objtype == mjOBJ_GEOM && car_parts_[static_cast<std::size_t>(geom.objid)].of_car;
  });
}

void FilmScene::PaintCar() {
  mjvScene& scene = scene_.get();
  const Color color = recording_.plants.front().color();
  for (int i = 0; i < scene.ngeom; ++i) {
    mjvGeom& geom = scene.geoms[i];
    if (geom.objtype != mjOBJ_GEOM) {
      continue;
    }
    const CarPart& part = car_parts_[static_cast<std::size_t>(geom.objid)];
    if (part.painted) {
      geom.rgba[0] = kPaintShade * color.r;
      geom.rgba[1] = kPaintShade * color.g;
      geom.rgba[2] = kPaintShade * color.b;
    }
  }
}

void FilmScene::AddPatches(const CameraPose& camera) {
  const Vec2 around(camera.target_x, camera.target_y);
  for (const Tile& tile : patches_) {
    const double reach = kPaintRange + tile.half_length + tile.half_width;
    if ((tile.center.head<2>() - around).norm() < reach) {
      AddTile(scene_.get(), tile);
    }
  }
}

void FilmScene::AddContactShadow() {
  const mjModel& model = *recording_.model;
  mjvScene& scene = scene_.get();
  const int site = mj_name2id(&model, mjOBJ_SITE, "footprint");
  if (site < 0 || model.site_type[site] != mjGEOM_BOX) {
    return;
  }
  const mjtNum* center = car_data_->site_xpos + 3 * site;
  const mjtNum* rotation = car_data_->site_xmat + 9 * site;
  // The car's soft shadow lies in a plane through four points of the ground, one under the middle
  // of each side of the car's footprint.
  const Pose2 middle{center[0], center[1], std::atan2(rotation[3], rotation[0])};
  const auto side = [&](double forward, double left) {
    const Vec2 p = ToWorld(
        middle, {forward * model.site_size[3 * site], left * model.site_size[3 * site + 1]});
    return Eigen::Vector3d(p.x(), p.y(), GroundHeight(recording_.world, p));
  };
  const Eigen::Vector3d along = side(1.0, 0.0) - side(-1.0, 0.0);
  RowMajorMatrix3 flat;
  flat.col(0) = along.normalized();
  flat.col(2) = along.cross(side(0.0, 1.0) - side(0.0, -1.0)).normalized();
  flat.col(1) = flat.col(2).cross(flat.col(0));
  const Eigen::Vector3d place =
      0.25 * (side(1.0, 0.0) + side(-1.0, 0.0) + side(0.0, 1.0) + side(0.0, -1.0)) +
      box_.scale() * kShadowHeight * flat.col(2);
  const std::array<float, 4> rgba{0.0F, 0.0F, 0.02F, kShadowAlpha};
  for (int layer = 0; layer < kShadowLayers; ++layer) {
    // The smallest layer of the shadow is inside the car's outline, and the largest is outside.
    const double wider = box_.scale() * kShadowSpread * (layer - 0.5 * kShadowLayers);
    const std::array<mjtNum, 3> size{model.site_size[3 * site] + wider,
                                     model.site_size[3 * site + 1] + wider, 0.0005};
    AddDecor(scene, mjGEOM_BOX, size, place, flat, rgba);
  }
}

}  // namespace trackbed::render
