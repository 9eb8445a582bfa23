#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/recording.h"

namespace trackbed::render {

/// Where a picture is taken from: `distance` [m] from `target` on the line that looks along
/// `azimuth` (0 east, pi/2 north) and `elevation` (negative looks down) [rad].
struct CameraPose {
  double target_x = 0;
  double target_y = 0;
  double target_z = 0;
  double distance = 1;
  double azimuth = 0;
  double elevation = 0;
  double view_angle = 0.7;  ///< from the picture's bottom to its top [rad]
  double ground_z = 0;      ///< height of the ground where the target is [m]
  double paint_scale = 1;   ///< how much wider than usual lines on the ground must be to be seen
  bool inside = false;      ///< from inside the car, which is left out of the picture
};

/// What a camera may follow: the car's drive, smoothed, and the extent of the route.
///
/// The whole run is known, so smoothing looks both ways in time: no lag and no overshoot.
class CameraSubject {
 public:
  explicit CameraSubject(const Recording& recording);

  /// The car's rear-axle center as driven [m].
  [[nodiscard]] Point Position(double time) const { return car_.Position(time); }
  /// Position and heading averaged over about a second around `time`.
  [[nodiscard]] Point SmoothPosition(double time) const;
  [[nodiscard]] double SmoothHeading(double time) const;
  /// Height of the ground under the car, averaged in the same way [m].
  [[nodiscard]] double SmoothGround(double time) const;
  /// Share of the time around that moment that the car is in reverse gear, in [0, 1]. Standing, it
  /// is in the gear of its last motion.
  [[nodiscard]] double SmoothReverse(double time) const;
  /// The recording's first moment [s].
  [[nodiscard]] double begin() const { return car_.begin(); }
  /// As driven, not averaged [rad].
  [[nodiscard]] double Heading(double time) const { return car_.Heading(time); }
  /// Middle and half sides of the car's footprint in the vehicle frame, and its height [m].
  [[nodiscard]] const CarBox& box() const { return box_; }
  /// Of the plane that the ground is but for what lies on it: dz/dx and dz/dy.
  [[nodiscard]] const Vec2& grade() const { return recording_.world.ground.grade; }

  /// The rectangle around the plan, the new ones and every plant's drive [m].
  [[nodiscard]] Point lowest() const { return lowest_; }
  [[nodiscard]] Point highest() const { return highest_; }

 private:
  const Recording& recording_;
  const PlantRecording& car_;
  Point lowest_;
  Point highest_;
  CarBox box_;
  std::vector<double> reverse_;  // 1 in reverse gear, else 0; for each row of the car's log
};

struct Camera {
  std::string_view name;
  std::string_view summary;
  /// `aspect` is the picture's width / height.
  CameraPose (*pose)(const CameraSubject& subject, double time, double aspect);
};

/// The only list of cameras; the default is first.
const std::vector<Camera>& CameraTable();

/// InputError with the nearest name, under `key`, when there is no such camera.
const Camera& FindCamera(const std::string& name, const char* key = "camera");

}  // namespace trackbed::render
