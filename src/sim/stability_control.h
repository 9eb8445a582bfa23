#pragma once

#include <array>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/driver_aids.h"

namespace trackbed {

/// The motion of a car that stability control measures.
struct CarMotion {
  double speed = 0.0;     ///< Speed of the rear axle along x [m/s].
  double yaw_rate = 0.0;  ///< Yaw rate [rad/s].
  double sideslip = 0.0;  ///< Sideslip angle at the center of gravity [rad].
  double steering = 0.0;  ///< Steering angle of the bicycle model at the front wheels [rad].
  double road = 1.0;      ///< Friction factor of the road, averaged over the wheels with the wheel
                          ///< loads as weights.
};

/// Electronic stability control (Rajamani 2012, ch. 8; van Zanten 2000).
///
/// The driver demands the yaw rate of the linear single-track model in a steady turn,
///   r_s = v tan(delta)/(L + K v^2),  limited to |r_s| <= 0.85 mu g/v,
/// with the understeer gradient K of the unladen car, and with mu = friction_lateral times the
/// road's friction factor. The yaw rate reference r follows the demanded yaw rate r_s with a lag
/// equal to the delay of the linear single-track model at low frequencies. The control acts if the
/// yaw rate leaves the band of 0.05 mu g/v about the reference r. The control also acts if the
/// sideslip angle exceeds atan(0.02 s^2/m mu g) while the heading turns away from the direction of
/// the velocity. If the yaw rate exceeds the band by e, the control commands the yaw moment
/// I_z e/0.02 s, with the yaw inertia I_z. If the sideslip angle exceeds its limit, the excess
/// divided by 0.02 s is added to e. Against oversteer, the outer front wheel brakes. Against
/// understeer, the inner rear wheel brakes. While stability control brakes a wheel, it also reduces
/// the drive torque to 0. The control acts only in forward motion at speeds of at least sqrt(g L),
/// with the wheelbase L.
class StabilityControl {
 public:
  StabilityControl(const CarModel& car, double gravity);

  /// Updates the commanded brake torques for a step of `timestep` [s].
  void Update(const CarMotion& motion, double timestep);

  /// Returns the state of the control, with the brake torques that the control commands.
  [[nodiscard]] const EscState& state() const { return state_; }

 private:
  /// Returns the commanded yaw moment [N m], positive to the left.
  [[nodiscard]] double Moment(const CarMotion& motion) const;

  const VehicleParams& params_;
  std::array<double, 2> largest_;  // Largest brake torque of each front and each rear wheel [N m].
  double gravity_;
  double understeer_;  // K [rad s^2/m]
  EscState state_;
  bool runs_ = false;  // Whether the yaw rate reference was computed in an earlier step.
};

}  // namespace trackbed
