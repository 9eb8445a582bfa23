#include "render/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "render/cone.h"
#include "render/error_ribbon.h"
#include "render/ghost.h"
#include "render/shadow.h"
#include "render/wind_arrows.h"
#include "trackbed/core/angle.h"

namespace trackbed::render {
namespace {

// How far a thinned line may leave the true one [m]: a twentieth of the narrowest ribbon.
constexpr double kLineTolerance = 0.005;
constexpr std::size_t kMostPieces = 3000;  // per line
// Paint farther than this from where the camera looks would be thinner than a pixel [m].
constexpr double kPaintRange = 250.0;

constexpr float kSunk = 0.002F;  // [m]; less than all paint is above the ground

constexpr double kGustWidth = 0.16;
constexpr double kGustHeight = 0.006;

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

/// A point each where the line bends and where its color changes.
std::vector<Trail> TrailsOf(const Recording& recording, const Overlays& overlays) {
  std::vector<Trail> trails;
  for (std::size_t car = 0; car < recording.plants.size(); ++car) {
    const PlantRecording& plant = recording.plants[car];
    std::vector<Point> driven;
    for (const double time : plant.times()) {
      driven.push_back(recording.OnGround(plant.Position(time)));
    }
    std::vector<std::size_t> kept = Thin(driven, kLineTolerance, kMostPieces);
    const bool colored = car == 0 && overlays.error && recording.scales.error > 0.0;
    const std::vector<double> shares = colored ? ErrorShares(recording) : std::vector<double>();
    for (std::size_t i = 1; i < shares.size(); ++i) {
      if (shares[i] != shares[i - 1]) {
        kept.push_back(i);
      }
    }
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    Trail trail;
    for (const std::size_t i : kept) {
      trail.points.push_back(driven[i]);
      trail.times.push_back(plant.times()[i]);
      if (!shares.empty()) {
        trail.colors.push_back(ErrorColor(shares[i]));
      }
    }
    trails.push_back(std::move(trail));
  }
  return trails;
}

int MaxGeoms(const Recording& recording, const std::vector<Tile>& patches,
             const std::vector<GustLine>& gusts, const std::vector<Trail>& trails) {
  std::size_t on_ground = patches.size();
  for (const GustLine& gust : gusts) {
    on_ground += gust.points.size();
  }
  const int cars = static_cast<int>(recording.plants.size());
  std::size_t of_new_plans = 0;
  for (const NewPlan& plan : recording.new_plans) {
    of_new_plans += std::min(plan.path.size(), kMostPieces + 2);
  }
  for (const Trail& trail : trails) {
    on_ground += trail.points.size();
  }
  return (recording.model->ngeom + recording.model->ngeom) * cars + 200 * cars +
         static_cast<int>(on_ground) + kMostWindPieces + static_cast<int>(kMostPieces + 2) +
         static_cast<int>(of_new_plans) + static_cast<int>(kConePieces * recording.cones.size());
}

constexpr double kErrorWidth = 0.26;

constexpr double kPlanWidth = 0.48;
constexpr double kPlanHeight = 0.008;
// A plan that is given up fades into the asphalt, not to translucent paint: that would be darker
// where two pieces overlap. It is narrower than the trails of ghosts, so what is left of it to see
// is what was not driven.
constexpr double kGivenUpWidth = 0.24;
constexpr Color kAsphalt{0.60F, 0.62F, 0.60F};
constexpr float kGivenUpShare = 0.35F;  // of its own color
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

FilmScene::FilmScene(Recording& recording, const Overlays& overlays, bool shadows)
    : recording_(recording),
      overlays_(overlays),
      trails_(TrailsOf(recording, overlays)),
      patches_(PatchTiles(recording.world)),
      gusts_(GustLines(recording)),
      car_data_(mj_makeData(recording.model.get())),
      ghost_data_(mj_makeData(recording.model.get())),
      scene_(*recording.model, MaxGeoms(recording, patches_, gusts_, trails_)),
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
  if (overlays_.wind) {
    AddGusts(time, camera);
    AddWindArrows(scene_.get(), recording_, time, camera);
  }
  if (overlays_.plan) {
    AddPlans(time, camera);
  }
  for (std::size_t car = 0; car < recording_.plants.size(); ++car) {
    if (car == 0 ? overlays_.trail || overlays_.error : overlays_.trail && overlays_.ghosts) {
      AddTrail(car, time, camera);
    }
  }
  for (const Point& cone : recording_.cones) {
    AddCone(scene_.get(), cone);
  }
  if (scene_.get().flags[mjRND_SHADOW] == 0) {
    AddContactShadow();
  }
  for (std::size_t car = 1; overlays_.ghosts && car < recording_.plants.size(); ++car) {
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
    if ((tile.center.head<2>() - around).norm() < reach) {
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
  RibbonStyle style = TrailStyle(car, camera.paint_scale);
  if (!trail.colors.empty()) {
    style.width = kErrorWidth * camera.paint_scale;
  }
  for (std::size_t i = 1; i < trail.points.size() && trail.times[i - 1] < time; ++i) {
    // The last piece grows with the car.
    const Point end = trail.times[i] <= time
                          ? trail.points[i]
                          : recording_.OnGround(recording_.plants[car].Position(time));
    if (!trail.colors.empty()) {
      style.color = trail.colors[i - 1];
    }
    if (IsNear(trail.points[i - 1], end, around)) {
      AddPiece(trail.points[i - 1], end, style);
    }
  }
}

}  // namespace trackbed::render
