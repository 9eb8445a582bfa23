#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/recording.h"

namespace trackbed::render {

/// Pose of a camera that looks at `target` from `distance` [m], in the direction `azimuth` and
/// `elevation` [rad]. An azimuth of 0 means looking east and pi/2 north; at a negative elevation,
/// the camera looks down.
struct CameraPose {
  double target_x = 0;
  double target_y = 0;
  double target_z = 0;
  double distance = 1;
  double azimuth = 0;
  double elevation = 0;
  double view_angle = 0.7;  ///< Vertical angle of view of the camera [rad].
  double ground_z = 0;      ///< Height of the ground at the camera's target [m].
  /// Factor on the width of lines painted on the ground, to keep these lines visible.
  double paint_scale = 1;
  bool inside = false;  ///< Whether the camera is inside the car; if so, the car is not drawn.
};

/// The subject of a camera: the smoothed motion of the car, and the extent of the route.
///
/// As the recording contains the whole run, the car's motion is smoothed symmetrically in time,
/// without lag or overshoot.
class CameraSubject {
 public:
  explicit CameraSubject(const Recording& recording);

  /// Position of the car's rear-axle center, not averaged over time [m].
  [[nodiscard]] Point Position(double time) const { return car_.Position(time); }
  /// Position and heading of the car, averaged over about a second around `time`.
  [[nodiscard]] Point SmoothPosition(double time) const;
  [[nodiscard]] double SmoothHeading(double time) const;
  /// Height of the ground under the car, averaged over about a second around `time` [m].
  [[nodiscard]] double SmoothGround(double time) const;
  /// Returns the weighted fraction, in [0, 1], of the time around `time` that the car spends in
  /// reverse gear. A car at rest is treated as being in the gear of its last motion.
  [[nodiscard]] double SmoothReverse(double time) const;
  /// Start time of the recording [s].
  [[nodiscard]] double begin() const { return car_.begin(); }
  /// Heading of the car, not averaged over time [rad].
  [[nodiscard]] double Heading(double time) const { return car_.Heading(time); }
  /// Center and half sides of the car's footprint in the vehicle frame [m], and the car's height
  /// [m].
  [[nodiscard]] const CarBox& box() const { return box_; }
  /// Slope of the ground plane without bumps and other features, as (dz/dx, dz/dy).
  [[nodiscard]] const Vec2& grade() const { return recording_.world.ground.grade; }

  /// Corner with the smallest x and y of the rectangle that contains the plan, the replanned paths
  /// and every plant's path [m].
  [[nodiscard]] Point lowest() const { return lowest_; }
  [[nodiscard]] Point highest() const { return highest_; }

 private:
  const Recording& recording_;
  const PlantRecording& car_;
  Point lowest_;
  Point highest_;
  CarBox box_;
  std::vector<double> reverse_;  // for each row of the car's log: 1 if the car is in reverse gear,
                                 // else 0
};

struct Camera {
  std::string_view name;
  /// `aspect` is the ratio of a frame's width to its height.
  CameraPose (*pose)(const CameraSubject& subject, double time, double aspect);
};

/// Returns the poses of all cameras of CameraNames(), in the same order.
const std::vector<Camera>& CameraTable();

/// Returns the camera with the given name. Throws InputError for the option `key`, suggesting the
/// most similar name, if no camera has this name.
const Camera& FindCamera(const std::string& name, const char* key = "camera");

}  // namespace trackbed::render
