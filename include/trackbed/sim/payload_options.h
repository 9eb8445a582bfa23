#pragma once

#include <optional>

namespace trackbed {

/// A payload, which is a point mass fixed to the chassis. The position of a payload is given in the
/// car's frame: x forward from the rear axle, y to the left, z up from the ground.
struct Payload {
  std::optional<double> mass;   ///< Mass [kg], > 0; only one of `mass` and `share` may be given.
  std::optional<double> share;  ///< Mass as a fraction of the car's mass, > 0.
  double x = 0.0;               ///< Position along x [m]; 0: above the rear axle.
  double y = 0.0;               ///< Position along y [m].
  std::optional<double> z;      ///< Height [m]; nullopt: that of the car's center of gravity.
};

}  // namespace trackbed
