#include "render/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "render/cone.h"
#include "render/shadow.h"
#include "trackbed/core/angle.h"

namespace trackbed::render {
namespace {

// How far a thinned line may leave the true one [m]: a twentieth of the narrowest ribbon.
constexpr double kLineTolerance = 0.005;
constexpr std::size_t kMostPieces = 3000;  // per line
// Paint farther than this from where the camera looks would be thinner than a pixel [m].
constexpr double kPaintRange = 250.0;

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

constexpr float kSunk = 0.002F;  // [m]; less than all paint is above the ground

constexpr double kGustWidth = 0.16;
constexpr double kGustHeight = 0.006;

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

std::vector<Point> Thinned(const std::vector<Point>& line) {
  std::vector<Point> points;
  for (const std::size_t i : Thin(line, kLineTolerance, kMostPieces)) {
    points.push_back(line[i]);
  }
  return points;
}

std::vector<GustLine> GustLines(const Recording& recording) {
  std::vector<GustLine> lines;
  for (const Gust& gust : recording.world.wind.gusts) {
    if (gust.area) {
      lines.push_back({gust, Thinned(Outline(recording, gust.area->Corners()))});
    }
  }
  return lines;
}

int MaxGeoms(const Recording& recording, const std::vector<Tile>& patches,
             const std::vector<GustLine>& gusts) {
  std::size_t on_ground = patches.size();
  for (const GustLine& gust : gusts) {
    on_ground += gust.points.size();
  }
  const int cars = static_cast<int>(recording.plants.size());
  std::size_t of_new_plans = 0;
  for (const NewPlan& plan : recording.new_plans) {
    of_new_plans += std::min(plan.path.size(), kMostPieces + 2);
  }
  return (recording.model->ngeom + recording.model->ngeom) * cars + 200 * cars +
         static_cast<int>(on_ground) + static_cast<int>(kMostPieces + 2) * (cars + 1) +
         static_cast<int>(of_new_plans) + static_cast<int>(kConePieces * recording.cones.size());
}

/// Like the lines of a transport map: each narrower than the one it covers.
RibbonStyle TrailStyle(std::size_t car, double scale) {
  if (car == 0) {
    return {CarColor(0), 0.14 * scale, 0.024};
  }
  return {CarColor(car), 0.28 * scale, std::max(0.018 - 0.002 * static_cast<double>(car), 0.010)};
}

constexpr double kPlanWidth = 0.48;
constexpr double kPlanHeight = 0.008;
// A plan that is given up fades into the asphalt, not to translucent paint: that would be darker
// where two pieces overlap. It is narrower than the trails of ghosts, so what is left of it to see
// is what was not driven.
constexpr double kGivenUpWidth = 0.24;
constexpr Color kAsphalt{0.60F, 0.62F, 0.60F};
constexpr float kGivenUpShare = 0.35F;  // of its own colour
// A plan that was driven for less than this leaves nothing behind: planning again twice a second
// would fill the road with fans of lines [s].
constexpr double kBrief = 1.0;

/// `newer` plans have been taken up since.
RibbonStyle PlanStyle(const Color& color, std::size_t newer, double scale) {
  if (newer == 0) {
    return {color, kPlanWidth * scale, kPlanHeight};
  }
  const auto fade = [](float own, float asphalt) {
    return asphalt + kGivenUpShare * (own - asphalt);
  };
  // Most lie on each other where they rejoin the route: the newer above the older.
  return {{fade(color.r, kAsphalt.r), fade(color.g, kAsphalt.g), fade(color.b, kAsphalt.b)},
          kGivenUpWidth * scale,
          std::max(kPlanHeight - 0.001 * static_cast<double>(newer), 0.002)};
}

bool IsNear(const Point& a, const Point& b, const Point& around) {
  const double reach = kPaintRange + std::hypot(b.x - a.x, b.y - a.y);
  return std::hypot(a.x - around.x, a.y - around.y) < reach;
}

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

/// Whether a camera can see beyond the ground. If not, the sky behind it need not be drawn, which
/// is a third of a picture's time.
bool SeesSky(const mjModel& model, const World& world, const CameraPose& camera) {
  const int ground = mj_name2id(&model, mjOBJ_GEOM, "ground");
  const bool endless = ground >= 0 && model.geom_type[ground] == mjGEOM_PLANE &&
                       model.geom_size[3 * ground] == 0 && model.geom_size[3 * ground + 1] == 0;
  constexpr double kHaze = 0.1;                                  // [rad] under the horizon
  const double horizon = -std::atan(world.ground.grade.norm());  // down the hill
  return !endless || camera.elevation + 0.5 * camera.view_angle > horizon - kHaze;
}

/// Where they rise by nothing they would flicker on the plane that they stand on.
void SinkHeightFields(mjvScene& scene) {
  for (int i = 0; i < scene.ngeom; ++i) {
    if (scene.geoms[i].type == mjGEOM_HFIELD) {
      scene.geoms[i].pos[2] -= kSunk;
    }
  }
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

FilmScene::FilmScene(Recording& recording, bool shadows)
    : recording_(recording),
      patches_(PatchTiles(recording.world)),
      gusts_(GustLines(recording)),
      car_data_(mj_makeData(recording.model.get())),
      ghost_data_(mj_makeData(recording.model.get())),
      scene_(*recording.model, MaxGeoms(recording, patches_, gusts_)),
      ghost_scene_(*recording.model, 2 * recording.model->ngeom + 100) {
  mjv_defaultOption(&visible_);
  std::fill(std::begin(visible_.sitegroup), std::end(visible_.sitegroup), mjtByte{0});
  mjv_defaultFreeCamera(recording.model.get(), &camera_);
  scene_.get().flags[mjRND_SHADOW] = shadows ? 1 : 0;
  scene_.get().flags[mjRND_REFLECTION] = 0;

  AddPlanLine(recording.begin(), kPlanColor, recording.plan);
  for (const NewPlan& plan : recording.new_plans) {
    AddPlanLine(plan.from, kNewPlanColor, plan.path);
  }
  for (const PlantRecording& plant : recording.plants) {
    std::vector<Point> driven;
    for (const double time : plant.times()) {
      driven.push_back(recording.OnGround(plant.Position(time)));
    }
    Trail trail;
    for (const std::size_t i : Thin(driven, kLineTolerance, kMostPieces)) {
      trail.points.push_back(driven[i]);
      trail.times.push_back(plant.times()[i]);
    }
    trails_.push_back(std::move(trail));
  }
}

void FilmScene::AddPlanLine(double from, const Color& color, const std::vector<Point>& path) {
  std::vector<Point> points;
  for (const Point& point : path) {
    points.push_back(recording_.OnGround(point));
  }
  plans_.push_back({from, color, Thinned(points)});
}

mjvScene& FilmScene::At(double time, const CameraPose& camera) {
  mjModel& model = *recording_.model;
  Aim(camera);
  recording_.plants.front().Pose(time, model, *car_data_);
  mjv_updateScene(&model, car_data_.get(), &visible_, nullptr, &camera_, mjCAT_ALL, &scene_.get());
  SinkHeightFields(scene_.get());
  scene_.get().flags[mjRND_SKYBOX] = SeesSky(model, recording_.world, camera) ? 1 : 0;
  AimLamps(scene_.get(), camera);
  AddPatches(camera);
  AddGusts(time, camera);
  AddPlans(time, camera);
  for (std::size_t car = 0; car < recording_.plants.size(); ++car) {
    AddTrail(car, time, camera);
  }
  for (const Point& cone : recording_.cones) {
    AddCone(scene_.get(), cone);
  }
  if (scene_.get().flags[mjRND_SHADOW] == 0) {
    AddContactShadow();
  }
  for (std::size_t car = 1; car < recording_.plants.size(); ++car) {
    AddGhost(car, time, camera);
  }
  return scene_.get();
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
  // As far out as the car allows: it is what lets a depth buffer tell paint from road.
  model.vis.map.znear = static_cast<float>(0.1 * camera.distance / model.stat.extent);
  model.vis.map.zfar = static_cast<float>((1000.0 + 2.0 * camera.distance) / model.stat.extent);
}

void FilmScene::AddPiece(const Point& a, const Point& b, const RibbonStyle& style) {
  AddRibbonPiece(scene_.get(), a, b, style,
                 GroundNormal(recording_.world, {0.5 * (a.x + b.x), 0.5 * (a.y + b.y)}));
}

void FilmScene::AddPatches(const CameraPose& camera) {
  const Vec2 around(camera.target_x, camera.target_y);
  for (const Tile& tile : patches_) {
    const double reach = kPaintRange + tile.half_length + tile.half_width;
    if ((tile.centre.head<2>() - around).norm() < reach) {
      AddTile(scene_.get(), tile);
    }
  }
}

void FilmScene::AddGusts(double time, const CameraPose& camera) {
  const Point around{camera.target_x, camera.target_y};
  for (const GustLine& line : gusts_) {
    if (GustStrength(line.gust, time) == 0.0) {
      continue;
    }
    const RibbonStyle style{kGustColor, kGustWidth * camera.paint_scale, kGustHeight};
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      if (IsNear(line.points[i - 1], line.points[i], around)) {
        AddPiece(line.points[i - 1], line.points[i], style);
      }
    }
  }
}

void FilmScene::AddPlans(double time, const CameraPose& camera) {
  const Point around{camera.target_x, camera.target_y};
  const auto held = static_cast<std::size_t>(std::count_if(
      plans_.begin(), plans_.end(), [time](const PlanLine& line) { return line.from <= time; }));
  for (std::size_t plan = 0; plan < held; ++plan) {
    const bool is_new = plan > 0 && plan + 1 < held;
    if (is_new && plans_[plan + 1].from - plans_[plan].from < kBrief) {
      continue;
    }
    const std::vector<Point>& points = plans_[plan].points;
    const RibbonStyle style = PlanStyle(plans_[plan].color, held - 1 - plan, camera.paint_scale);
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (IsNear(points[i - 1], points[i], around)) {
        AddPiece(points[i - 1], points[i], style);
      }
    }
  }
}

void FilmScene::AddTrail(std::size_t car, double time, const CameraPose& camera) {
  const Point around{camera.target_x, camera.target_y};
  const Trail& trail = trails_[car];
  const RibbonStyle style = TrailStyle(car, camera.paint_scale);
  for (std::size_t i = 1; i < trail.points.size() && trail.times[i - 1] < time; ++i) {
    // The last piece grows with the car.
    const Point end = trail.times[i] <= time
                          ? trail.points[i]
                          : recording_.OnGround(recording_.plants[car].Position(time));
    if (IsNear(trail.points[i - 1], end, around)) {
      AddPiece(trail.points[i - 1], end, style);
    }
  }
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
