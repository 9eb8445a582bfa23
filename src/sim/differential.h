#pragma once

namespace trackbed {

/// A wheel of a driven axle at the start of a step.
struct AxleWheel {
  double speed = 0.0;     ///< Angular speed of the wheel [rad/s].
  double inertia = 0.0;   ///< Wheel's moment of inertia about the spin axis [kg m^2], > 0.
  double torque = 0.0;    ///< Sum of the torques on the wheel without dry friction [N m].
  double friction = 0.0;  ///< Largest dry friction torque of brake and bearing [N m], >= 0.
};

/// Returns the torque [N m] that the coupling (clutch or lock) of a differential transmits from the
/// right to the left wheel in a step of `timestep` [s]. The transmitted torque makes both wheels
/// turn at the same speed at the end of the step. The transmitted torque is clamped to `most` [N
/// m], >= 0, in both directions. If the torque limit `most` is infinite, the differential is
/// locked.
///
/// The wheels' dry friction acts in the same step. With the transmitted torque c, the speed of a
/// wheel at the end of the step is S(omega + (T + c) dt/I, T_f dt/I). In this formula, omega is the
/// wheel's speed, I its inertia, T its torque without dry friction and T_f its friction torque;
/// S(u, b) moves u toward zero by b. The difference of the two wheel speeds is a nondecreasing,
/// piecewise linear function of the torque c with four corners; CouplingTorque finds its root
/// between two corners. If several torques yield equal wheel speeds, because the brakes hold both
/// wheels, the result is the smallest torque.
double CouplingTorque(const AxleWheel& left, const AxleWheel& right, double most, double timestep);

}  // namespace trackbed
