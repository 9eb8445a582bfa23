#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <string>
#include <vector>

#include "render/camera.h"
#include "render/ground_paint.h"
#include "render/handles.h"
#include "render/overlays.h"
#include "render/recording.h"
#include "render/ribbon.h"

namespace trackbed::render {

/// The colors of a film: of the planned path, of one taken up on the way, and of each car's trail
/// (the main car's first).
constexpr Color kPlanColor{1.00F, 1.00F, 0.97F};
constexpr Color kNewPlanColor{1.00F, 0.84F, 0.05F};  // as temporary markings overrule white ones
constexpr Color kGustColor{0.66F, 0.56F, 0.96F};     // around where a gust blows
constexpr Color kWindColor{0.80F, 0.76F, 1.00F};     // arrows of the wind
Color CarColor(std::size_t car);

/// The outline of an area in which a gust blows.
struct GustLine {
  Gust gust;
  std::vector<Point> points;
};

/// A thinned drive: point i was reached at times[i], and the piece from it on has colors[i], or the
/// car's where there are none.
struct Trail {
  std::vector<Point> points;
  std::vector<double> times;
  std::vector<Color> colors;
};

/// The recorded world, posed at a moment, and the overlays in it: all but forces, strip and
/// caption.
class FilmScene {
 public:
  /// Borrows the recording, and its model's visual settings (lens and clipping), for its lifetime.
  /// `shadows` are MuJoCo's, cast by the model's lights; without, a soft patch under the car.
  FilmScene(Recording& recording, const Overlays& overlays, bool shadows);

  /// The scene at `time` [s] from `camera`; valid until the next call.
  mjvScene& At(double time, const CameraPose& camera);
  /// The car as the last scene has it.
  [[nodiscard]] const mjData& car() const { return *car_data_; }

 private:
  /// A thinned plan, and from when it holds.
  struct PlanLine {
    double from;
    Color color;
    std::vector<Point> points;
  };

  void AddPlanLine(double from, const Color& color, const std::vector<Point>& path);
  void Aim(const CameraPose& camera);
  void AddPiece(const Point& a, const Point& b, const RibbonStyle& style);
  void AddPatches(const CameraPose& camera);
  void AddGusts(double time, const CameraPose& camera);
  void AddPlans(double time, const CameraPose& camera);
  void AddTrail(std::size_t car, double time, const CameraPose& camera);
  void AddGhost(std::size_t car, double time, const CameraPose& camera);
  void AddContactShadow();
  void AddFootprint(const mjData& data, const RibbonStyle& style);

  Recording& recording_;
  Overlays overlays_;
  std::vector<Trail> trails_;
  std::vector<Tile> patches_;
  std::vector<GustLine> gusts_;
  DataHandle car_data_;
  DataHandle ghost_data_;
  SceneHandle scene_;
  SceneHandle ghost_scene_;
  mjvOption visible_;
  mjvCamera camera_;
  std::vector<PlanLine> plans_;  // in the order of time
};

}  // namespace trackbed::render
