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

/// Drawing properties of a geom of the model.
struct CarPart {
  bool of_car = false;
  bool painted = false;  ///< whether the geom has the plant's color
};

/// Finds the drawing properties of each geom of the model.
std::vector<CarPart> FindCarParts(const mjModel& model);

/// The recorded world at a given time, with the shapes of overlays.
class FilmScene {
 public:
  /// FilmScene keeps references to the recording and the overlays. The scene changes the lens and
  /// clipping in the model's visual settings. With `shadows`, the model's lights cast MuJoCo's
  /// shadows; otherwise a soft dark patch lies under the car.
  FilmScene(Recording& recording, const OverlayList& overlays, bool shadows);

  /// The scene at `time` [s] from `camera`; valid until the next call.
  mjvScene& At(double time, const CameraPose& camera);
  /// State of the car in the last scene.
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
  std::vector<CarPart> car_parts_;   // Properties of each geom of the model.
  std::vector<int> obstacle_geoms_;  // Geom of each of the world's obstacles; -1: not in the model.
  MujocoData car_data_;
  SceneHandle scene_;
  mjvOption visible_;
  mjvCamera camera_;
};

}  // namespace trackbed::render
