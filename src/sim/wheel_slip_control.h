#pragma once

#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {

/// The motion of a wheel and the forces on its tyre in the present step.
struct WheelMotion {
  double rolling_speed = 0.0;       ///< Forward speed v of the hub [m/s].
  double spin = 0.0;                ///< Angular speed omega of the wheel [rad/s].
  double load = 0.0;                ///< Normal force F_z [N], >= 0.
  double longitudinal_force = 0.0;  ///< Force F_x on the car along the wheel's heading [N].
  double road = 1.0;                ///< Friction factor of the road under the wheel.
};

/// Constant parameters of a wheel that its slip control uses.
struct BrakedWheel {
  double radius = 0.0;   ///< Wheel radius R [m].
  double inertia = 0.0;  ///< Wheel's moment of inertia I about the spin axis [kg m^2].
  double largest = 0.0;  ///< Largest brake torque of the wheel [N m].
  /// Brake slip at the largest braking force on a dry road, and this force divided by the wheel
  /// load.
  double peak_slip = 0.0;
  double peak_friction = 0.0;
  double slowest = 0.0;  ///< Forward speed below which slip control does not act [m/s].
};

/// Returns the constants of a wheel whose tyre carries `load` [N] at rest. MakeBrakedWheel searches
/// the largest braking force at brake slips up to 0.3.
BrakedWheel MakeBrakedWheel(const MagicFormula& tyre, double load, double radius, double inertia,
                            double largest);

/// Controls the brake slip of one wheel (van Zanten 2000).
///
/// The target of the brake slip is kappa* = kappa_p (0.1 + 0.9 u) with the used friction u. The
/// constant kappa_p is the slip at the largest braking force on a dry road. The used friction u is
/// the force ratio |F_x|/F_z, divided by the largest |F_x|/F_z on a dry road. A road with the
/// friction factor lambda scales the tyre's curve u(kappa), used friction over slip, by lambda
/// along both axes. Let the peak be the slip kappa at which u(kappa) is largest. If the slip is
/// below the peak, the target slip exceeds the slip; if the slip is beyond the peak, the target
/// slip is less than the slip. The slip therefore converges to the peak although the controller
/// does not use the road's friction factor lambda. In a turn, the lateral slip reduces the braking
/// force |F_x| and the target slip, so that the tyre can still generate lateral force.
///
/// The control limits the driver's brake torque to T = |F_x| R - I omega', with the wheel's radius
/// R and spin inertia I. The spin acceleration omega' is chosen such that the slip approaches its
/// target with a time constant of 20 ms. The brake torque limit changes at most as fast as a
/// hydraulic unit permits.
class WheelSlipControl {
 public:
  explicit WheelSlipControl(const BrakedWheel& wheel) : wheel_(wheel) {}

  /// Updates the brake torque limit for a step of `timestep` [s] in which the brake torque `wanted`
  /// [N m] is commanded. `acceleration` is the car's acceleration along x [m/s^2]. A used friction
  /// u below `least_use` (0 to 1) is replaced by `least_use`.
  void Update(const WheelMotion& motion, double wanted, double acceleration, double least_use,
              double timestep);
  /// Ends the slip control of the wheel, so that its brake torque is no longer limited.
  void Release() { active_ = false; }

  /// Whether the slip control presently limits the brake torque.
  [[nodiscard]] bool active() const { return active_; }
  /// Returns the largest permitted brake torque [N m]; infinite if the control is not active.
  [[nodiscard]] double limit() const;

 private:
  BrakedWheel wheel_;
  bool active_ = false;
  double limit_ = 0.0;  // [N m]
};

/// Moves the brake torque `from` [N m] toward `to` at the rates of a hydraulic unit. The hydraulic
/// unit raises the brake torque from 0 to `largest` in 0.1 s, and lowers the brake torque from
/// `largest` to 0 in 0.05 s.
double MoveBrakeTorque(double from, double to, double largest, double timestep);

}  // namespace trackbed
