#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/recording.h"

namespace trackbed::render {

/// Camera pose: looks at `target` from `distance` [m], along `azimuth` and `elevation` [rad].
/// Azimuth is 0 to the east and pi/2 to the north; a negative elevation looks down.
struct CameraPose {
  double target_x = 0;
  double target_y = 0;
  double target_z = 0;
  double distance = 1;
  double azimuth = 0;
  double elevation = 0;
  double view_angle = 0.7;  ///< Vertical angle of view [rad].
  double ground_z = 0;      ///< Height of the ground at the target [m].
  double paint_scale = 1;   ///< Factor on the width of lines on the ground that keeps them visible.
  bool inside = false;      ///< Whether the camera is inside the car; then the car is not drawn.
};

/// Subject of a camera: the car's smoothed motion, and the extent of the route.
///
/// The whole run is known, so the motion is smoothed symmetrically in time, without lag or
/// overshoot.
class CameraSubject {
 public:
  explicit CameraSubject(const Recording& recording);

  /// The driven position of the car's rear-axle center [m].
  [[nodiscard]] Point Position(double time) const { return car_.Position(time); }
  /// Position and heading of the car, averaged over about a second around `time`.
  [[nodiscard]] Point SmoothPosition(double time) const;
  [[nodiscard]] double SmoothHeading(double time) const;
  /// Height of the ground under the car, averaged over about a second around `time` [m].
  [[nodiscard]] double SmoothGround(double time) const;
  /// Weighted fraction of the time around `time` in reverse gear, in [0, 1]. A car at rest counts
  /// as in the gear of its last motion.
  [[nodiscard]] double SmoothReverse(double time) const;
  /// Start time of the recording [s].
  [[nodiscard]] double begin() const { return car_.begin(); }
  /// The driven heading, without averaging [rad].
  [[nodiscard]] double Heading(double time) const { return car_.Heading(time); }
  /// Middle and half sides of the car's footprint in the vehicle frame, and its height [m].
  [[nodiscard]] const CarBox& box() const { return box_; }
  /// Slope of the ground plane, without bumps and other features: dz/dx and dz/dy.
  [[nodiscard]] const Vec2& grade() const { return recording_.world.ground.grade; }

  /// The bounding rectangle of the plan, the replanned paths and every plant's path [m].
  [[nodiscard]] Point lowest() const { return lowest_; }
  [[nodiscard]] Point highest() const { return highest_; }

 private:
  const Recording& recording_;
  const PlantRecording& car_;
  Point lowest_;
  Point highest_;
  CarBox box_;
  std::vector<double> reverse_;  // 1 in reverse gear, else 0; one value per row of the car's log
};

struct Camera {
  std::string_view name;
  std::string_view summary;
  /// `aspect` is the picture's width / height.
  CameraPose (*pose)(const CameraSubject& subject, double time, double aspect);
};

/// The registry of cameras; the first is the default.
const std::vector<Camera>& CameraTable();

/// Throws InputError under `key`, with the nearest name, if there is no such camera.
const Camera& FindCamera(const std::string& name, const char* key = "camera");

}  // namespace trackbed::render
