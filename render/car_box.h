#pragma once

#include <mujoco/mujoco.h>

#include <algorithm>

namespace trackbed::render {

/// Bounding box of a car that stands upright on the ground, in the vehicle frame [m].
struct CarBox {
  double middle = 1.3;  ///< x coordinate of the center of the box, measured from the rear axle
  double half_length = 2.2;
  double half_width = 0.9;
  double height = 1.5;
  double towed = 0.0;  ///< length of hitch and trailer behind the box; 0 without a trailer

  /// Returns the size of the car relative to a full-size car; films scale cameras, marks and
  /// shadows by the relative size. The relative size of the car is 1 for cars that are 4 m long or
  /// longer.
  [[nodiscard]] double scale() const { return std::min(1.0, half_length / 2.0); }
};

/// Returns the box of the model's site `footprint` and the length of the trailer, or the default
/// box if the model has no such site.
CarBox FindCarBox(const mjModel& model);

}  // namespace trackbed::render
