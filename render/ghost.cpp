#include "render/ghost.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "render/scene.h"

namespace trackbed::render {
namespace {

constexpr float kGhostAlpha = 0.22F;  // MuJoCo draws translucent surfaces twice: 1 - 0.78^2 = 0.39
constexpr float kGhostTint = 0.7F;
// A ghost leaves out parts smaller than this share of its largest one: spokes and lamps cannot be
// told apart in it, and with them it takes three times as long.
constexpr float kGhostDetail = 0.125F;
// A ghost is drawn this much farther from the camera [m]. Where it agrees with the car it is hidden
// behind the car's surface instead of flickering on it; where it departs by more it comes out. Less
// than that its footprint and its trail show better than patches of it on the car's doors would.
constexpr double kGhostBehind = 0.10;

// Nested dark layers: a soft contact shadow where the shadow map would cost half the time.
constexpr int kShadowLayers = 6;
constexpr float kShadowAlpha = 0.055F;  // of one layer, drawn twice like everything translucent
constexpr double kShadowSpread = 0.09;  // one layer beyond the next [m]
constexpr double kShadowHeight = 0.03;  // above all paint [m]

float LargestSide(const mjvGeom& geom) {
  return std::max({geom.size[0], geom.size[1], geom.size[2]});
}

void MakeGhostly(mjvGeom& geom, const Color& color) {
  const std::array<float, 3> tint{color.r, color.g, color.b};
  for (std::size_t i = 0; i < 3; ++i) {
    geom.rgba[i] = (1.0F - kGhostTint) * geom.rgba[i] + kGhostTint * tint[i];
  }
  geom.rgba[3] = kGhostAlpha;
  geom.emission = 0.3F;
  geom.specular *= 0.3F;
  geom.reflectance = 0.0F;
  geom.texid = -1;
}

}  // namespace

Color CarColor(std::size_t car) {
  constexpr std::array<Color, 5> kColors{{{1.00F, 0.47F, 0.08F},
                                          {0.10F, 0.75F, 0.95F},
                                          {0.85F, 0.25F, 0.70F},
                                          {0.55F, 0.80F, 0.20F},
                                          {0.98F, 0.85F, 0.25F}}};
  return kColors[car < kColors.size() ? car : 1 + (car - 1) % (kColors.size() - 1)];
}

RibbonStyle TrailStyle(std::size_t car, double scale) {
  if (car == 0) {
    return {CarColor(0), 0.14 * scale, 0.024};
  }
  return {CarColor(car), 0.28 * scale, std::max(0.018 - 0.002 * static_cast<double>(car), 0.010)};
}

/// Around a rectangle, on the ground.
std::vector<Point> Outline(const Recording& recording, const std::array<Vec2, 4>& corners) {
  // Short enough for the ground's shapes.
  const double longest = IsFlat(recording.world.ground) ? 1e6 : 0.25;
  std::vector<Point> points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 side = corners[(i + 1) % corners.size()] - corners[i];
    const auto pieces = static_cast<int>(std::ceil(side.norm() / longest));
    for (int piece = 0; piece < pieces; ++piece) {
      const Vec2 p = corners[i] + side * (static_cast<double>(piece) / pieces);
      points.push_back(recording.OnGround({p.x(), p.y()}));
    }
  }
  points.push_back(points.front());
  return points;
}

void FilmScene::AddGhost(std::size_t car, double time, const CameraPose& camera) {
  const mjModel& model = *recording_.model;
  mjvScene& ghost = ghost_scene_.get();
  mjvScene& scene = scene_.get();
  recording_.plants[car].Pose(time, model, *ghost_data_);
  mjv_updateScene(&model, ghost_data_.get(), &visible_, nullptr, &camera_, mjCAT_DYNAMIC, &ghost);
  const auto behind = static_cast<float>(kGhostBehind / camera.distance);
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
    MakeGhostly(geom, CarColor(car));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float eye = scene.camera[0].pos[axis];
      geom.pos[axis] += behind * (geom.pos[axis] - eye);
    }
    ++scene.ngeom;
  }
  RibbonStyle style = TrailStyle(car, camera.paint_scale);
  style.width = 0.06 * camera.paint_scale;
  AddFootprint(*ghost_data_, style);
}

void FilmScene::AddContactShadow() {
  const mjModel& model = *recording_.model;
  mjvScene& scene = scene_.get();
  const int site = mj_name2id(&model, mjOBJ_SITE, "outline");
  if (site < 0 || model.site_type[site] != mjGEOM_BOX) {
    return;
  }
  const mjtNum* center = car_data_->site_xpos + 3 * site;
  const mjtNum* rotation = car_data_->site_xmat + 9 * site;
  // On the plane through the ground under the middles of its sides.
  const Pose2 middle{center[0], center[1], std::atan2(rotation[3], rotation[0])};
  const auto side = [&](double forward, double left) {
    const Vec2 p = ToWorld(
        middle, {forward * model.site_size[3 * site], left * model.site_size[3 * site + 1]});
    return Eigen::Vector3d(p.x(), p.y(), GroundHeight(recording_.world, p));
  };
  const Eigen::Vector3d along = side(1.0, 0.0) - side(-1.0, 0.0);
  Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor> flat;
  flat.col(0) = along.normalized();
  flat.col(2) = along.cross(side(0.0, 1.0) - side(0.0, -1.0)).normalized();
  flat.col(1) = flat.col(2).cross(flat.col(0));
  const Eigen::Vector3d place =
      0.25 * (side(1.0, 0.0) + side(-1.0, 0.0) + side(0.0, 1.0) + side(0.0, -1.0)) +
      kShadowHeight * flat.col(2);
  const std::array<float, 4> rgba{0.0F, 0.0F, 0.02F, kShadowAlpha};
  for (int layer = 0; layer < kShadowLayers && scene.ngeom < scene.maxgeom; ++layer) {
    // From well inside the outline to as far outside.
    const double wider = kShadowSpread * (layer - 0.5 * kShadowLayers);
    const std::array<mjtNum, 3> size{model.site_size[3 * site] + wider,
                                     model.site_size[3 * site + 1] + wider, 0.0005};
    mjvGeom& geom = scene.geoms[scene.ngeom];
    mjv_initGeom(&geom, mjGEOM_BOX, size.data(), place.data(), flat.data(), rgba.data());
    geom.specular = 0.0F;
    geom.category = mjCAT_DECOR;
    ++scene.ngeom;
  }
}

void FilmScene::AddFootprint(const mjData& data, const RibbonStyle& style) {
  const mjModel& model = *recording_.model;
  const int site = mj_name2id(&model, mjOBJ_SITE, "outline");
  if (site < 0 || model.site_type[site] != mjGEOM_BOX) {
    return;
  }
  const mjtNum* center = data.site_xpos + 3 * site;
  const mjtNum* rotation = data.site_xmat + 9 * site;
  const mjtNum* size = model.site_size + 3 * site;
  const auto corner = [&](double forward, double left) {
    return Vec2(center[0] + rotation[0] * forward * size[0] + rotation[1] * left * size[1],
                center[1] + rotation[3] * forward * size[0] + rotation[4] * left * size[1]);
  };
  const std::vector<Point> outline =
      Outline(recording_, {corner(1, 1), corner(-1, 1), corner(-1, -1), corner(1, -1)});
  for (std::size_t i = 1; i < outline.size(); ++i) {
    AddPiece(outline[i - 1], outline[i], style);
  }
}

}  // namespace trackbed::render
