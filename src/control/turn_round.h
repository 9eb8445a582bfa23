#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Makes a car turn round if its target lies behind it.
///
/// Control laws such as pure pursuit steer by the sine of the angle u from the direction of motion
/// to the target point P. For a target behind the car (|u| > 90 degrees), the sine of u decreases
/// again. If the target is exactly behind the car, the sine of u is 0, so the car would drive
/// straight on, away from its path. Control laws that use the heading error psi saturate if the
/// target is behind the car. The sign of psi jumps at 180 degrees, so measurement noise would turn
/// the wheels back and forth. TurnRound replaces the control law while the target point P is behind
/// the car, but farther along the path than the car:
///   |u| > 90 degrees  and  (P - O) . t >= 0,
/// with O the rear axle and t the direction of the path at the car's station. The condition on (P -
/// O) . t excludes a car just before a hairpin whose target P lies behind it on the path after the
/// hairpin. To turn round, the car steers to the side of P with the angle TurnRoundLimit, until P
/// is no longer behind the car.
class TurnRound {
 public:
  /// Returns the commanded steering angle [rad] if the car must turn round, otherwise nullopt. The
  /// argument `u` is the angle from the direction of motion to the target point P [rad], from
  /// PreviewAngle. Call Steer once per control period.
  std::optional<double> Steer(const ControlInput& input, double u);

  /// Calls Steer with the default preview distance, for controllers without a preview point.
  std::optional<double> Steer(const ControlInput& input);

 private:
  double side_ = 0.0;  // Side to which the car turns round: +1 left, -1 right, 0 none.
};

}  // namespace trackbed
