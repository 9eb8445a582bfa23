#pragma once

#include <optional>

namespace trackbed {

/// A payload: a point mass on the chassis, in addition to the model. Axes are the car's: x forward
/// from the rear axle, y to the left, z up from the ground.
struct Payload {
  std::optional<double> mass;   ///< [kg], > 0; this or
  std::optional<double> share;  ///< of the car's own mass, > 0
  double x = 0.0;               ///< [m]; 0: over the rear axle
  double y = 0.0;               ///< [m]
  std::optional<double> z;      ///< [m]; none: as high as the car's own center of gravity
};

}  // namespace trackbed
