#pragma once

#include <mujoco/mujoco.h>

#include <vector>

#include "render/camera.h"
#include "render/ground_paint.h"
#include "render/overlay.h"
#include "render/recording.h"
#include "render/scene_handle.h"
#include "trackbed/sim/mujoco_handles.h"

namespace trackbed::render {

/// Drawing properties of one geom of the model.
struct CarPart {
  bool of_car = false;
  bool painted = false;  ///< whether the geom is drawn in the plant's color
};

/// Returns the drawing properties of each geom of the model.
std::vector<CarPart> FindCarParts(const mjModel& model);

/// The 3D scene of a film: the recorded world at a given time, with the shapes of overlays.
class FilmScene {
 public:
  /// A FilmScene keeps references to the recording and the overlays. FilmScene changes the lens and
  /// the clipping planes in the model's visual settings. If `shadows` is set, MuJoCo computes the
  /// shadows of the model's lights; otherwise a soft dark patch is drawn under the car.
  FilmScene(Recording& recording, const OverlayList& overlays, bool shadows);

  /// Returns the scene at `time` [s], as seen from `camera`. The returned scene is valid until the
  /// next call of At().
  mjvScene& At(double time, const CameraPose& camera);
  /// Returns MuJoCo's data of the car in the scene that At() returned last.
  [[nodiscard]] const mjData& car() const { return *car_data_; }

 private:
  void Aim(const CameraPose& camera);
  void AddPatches(const CameraPose& camera);
  void AddContactShadow();
  void FadeOccluders(double time, const CameraPose& camera);
  void HideCar();
  void PaintCar();

  Recording& recording_;
  const OverlayList& overlays_;
  std::vector<Tile> patches_;
  CarBox box_;
  std::vector<CarPart> car_parts_;  // Drawing properties of each geom of the model.
  // Index of each obstacle's geom; -1 if the model has no geom for the obstacle.
  std::vector<int> obstacle_geoms_;
  MujocoData car_data_;
  SceneHandle scene_;
  mjvOption visible_;
  mjvCamera camera_;
};

}  // namespace trackbed::render
