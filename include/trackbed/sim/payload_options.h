#pragma once

#include <optional>

namespace trackbed {

/// A payload: a point mass on the chassis, in addition to the model. The axes are those of the car:
/// x forward from the rear axle, y to the left, z up from the ground.
struct Payload {
  std::optional<double> mass;   ///< Mass [kg], > 0; excludes `share`.
  std::optional<double> share;  ///< Mass as a fraction of the car's mass, > 0.
  double x = 0.0;               ///< Coordinate x [m]; 0: over the rear axle.
  double y = 0.0;               ///< Coordinate y [m].
  std::optional<double> z;      ///< z [m]; none: at the height of the car's center of gravity.
};

}  // namespace trackbed
