#pragma once

#include <optional>

namespace trackbed {

/// A payload: a point mass on the chassis, in addition to the model. Axes are the car's: x forward
/// from the rear axle, y to the left, z up from the ground.
struct Payload {
  std::optional<double> mass;   ///< [kg], > 0; either this or `share`
  std::optional<double> share;  ///< fraction of the car's mass, > 0
  double x = 0.0;               ///< [m]; 0: over the rear axle
  double y = 0.0;               ///< [m]
  std::optional<double> z;      ///< [m]; none: at the height of the car's center of gravity
};

}  // namespace trackbed
