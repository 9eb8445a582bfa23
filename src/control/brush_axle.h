#pragma once

namespace trackbed {

/// Tyre forces of an axle.
struct AxleForces {
  double longitudinal = 0.0;  ///< [N]
  double lateral = 0.0;       ///< [N]
};

/// Slip and stiffness of an axle at an operating point.
struct AxleOperation {
  double slip = 0.0;       ///< Slip angle [rad] with the sign of the lateral force.
  double stiffness = 0.0;  ///< Derivative of the lateral force with respect to the slip angle, at
                           ///< constant longitudinal force, > 0 [N/rad].
};

/// The brush model with isotropic stiffness and friction (Pacejka 2012, ch. 3), at small slip. At
/// the slip sigma, the force in the direction of the slip is F = C sigma (1 - q + q^2/3) with q = C
/// sigma/(3 mu F_z). The force reaches mu F_z at q = 1. Solving the model for q gives
///   q = 1 - cbrt(1 - F/(mu F_z)),  S = C (1 - q + q^2/3),  T = C (1 - q)^2
/// with the secant stiffness S = F/sigma and the tangent stiffness T = dF/dsigma. The slip angle is
/// lateral/S. At constant longitudinal force, the lateral stiffness is S T/(S c^2 + T (1 - c^2))
/// with c = lateral/F.
///
/// C is `stiffness` [N/rad] and mu F_z is `friction_force` [N], both > 0. Forces of more than 0.95
/// mu F_z are scaled down to 0.95 mu F_z, because a sliding axle has no stiffness.
AxleOperation BrushAxleAt(double stiffness, double friction_force, const AxleForces& forces);

}  // namespace trackbed
