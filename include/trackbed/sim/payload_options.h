#pragma once

#include <optional>

namespace trackbed {

/// Options of a payload, which is a point mass fixed to the chassis. The position of the payload is
/// given in the car's frame, with x forward from the rear axle, y to the left, and z up from the
/// ground.
struct Payload {
  /// Mass of the payload [kg], > 0; only one of `mass` and `share` may be given.
  std::optional<double> mass;
  std::optional<double> share;  ///< Mass of the payload as a fraction of the car's mass, > 0.
  double x = 0.0;               ///< Position of the payload along x [m]; 0: above the rear axle.
  double y = 0.0;               ///< Position of the payload along y [m].
  /// Height of the payload above the ground [m]; nullopt: the height of the car's center of
  /// gravity.
  std::optional<double> z;
};

}  // namespace trackbed
