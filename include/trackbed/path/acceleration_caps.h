#pragma once

#include <limits>
#include <vector>

#include "trackbed/path/reference.h"

/// Speed profiles on a road whose grip or slope varies along the path.
namespace trackbed {

/// A section of a path on which the car can accelerate or brake less than elsewhere.
struct AccelerationCap {
  double from = 0.0;  ///< Start station [m].
  double to = 0.0;    ///< End station [m].
  /// Largest acceleration of the section [m/s^2], > 0; infinite if only SpeedLimits applies.
  double acceleration = std::numeric_limits<double>::infinity();
  /// Largest deceleration of the section [m/s^2], > 0; infinite if only SpeedLimits applies.
  double deceleration = std::numeric_limits<double>::infinity();
};

/// Makes the speed profile that StopAtEnd makes without acceleration caps, and also keeps the
/// acceleration and the deceleration within `sections`. The car brakes before a section if the
/// deceleration on the section is too small. If the start speed is too high for the path ahead, the
/// profile brakes at a constant deceleration above the limits until the speed is low enough. Throws
/// PreconditionError if a number is not finite; only the numbers of the caps may be infinite.
SpeedProfile StopAtEnd(double length, double start_speed, const SpeedLimits& limits,
                       const std::vector<SpeedCap>& caps,
                       const std::vector<AccelerationCap>& sections);

/// Makes a speed profile in the same way as StopAtEnd, but for a path with cusps. In the profile,
/// the car also stops at each cusp and at the stations `stops` [m].
SpeedProfile StopAtCusps(const Path& path, double start_speed, const SpeedLimits& limits,
                         const std::vector<SpeedCap>& caps, const std::vector<double>& stops,
                         const std::vector<AccelerationCap>& sections);

}  // namespace trackbed
