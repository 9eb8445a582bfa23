#pragma once

#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/trailer.h"

namespace trackbed {

/// A kinematic car with a trailer whose wheels do not slip (trailer.h). The trailer has no effect
/// on the car.
///
/// Guarantees: the hitch angle is exact except for rounding errors while the steering angle is
/// constant, for any duration and acceleration. While the steering angle changes, the error of the
/// hitch angle is that of a fourth-order integrator: below 1e-10 rad for steps up to 20 ms at 3
/// m/s.
class TowingCar {
 public:
  /// The argument `angle` is the hitch angle at the start [rad].
  TowingCar(const VehicleParams& params, ReferencePoint reference, const KinematicState& start,
            const TrailerParams& trailer, double angle);

  /// Advances car and trailer; see KinematicCar::Step.
  void Step(const Command& command, double duration);
  /// Displaces car and trailer by `left` [m] to the car's left.
  void ApplyLateralOffset(double left) { car_.ApplyLateralOffset(left); }

  [[nodiscard]] const KinematicState& state() const { return car_.state(); }
  [[nodiscard]] VehicleState FullState() const { return car_.FullState(); }
  /// Returns the state of the trailer at the end of the last step.
  [[nodiscard]] TrailerState trailer() const;

 private:
  /// Returns the speed of the rear axle divided by the speed of the reference point [1].
  [[nodiscard]] double RearShare(double steering) const;

  VehicleParams params_;
  ReferencePoint reference_;
  KinematicCar car_;
  TrailerParams trailer_;
  double angle_;  // Hitch angle [rad].
};

}  // namespace trackbed
