#pragma once

namespace trackbed {

/// Tyre forces of an axle.
struct AxleForces {
  double longitudinal = 0.0;  ///< [N]
  double lateral = 0.0;       ///< [N]
};

/// Slip and stiffness of an axle at an operating point.
struct AxleOperation {
  double slip = 0.0;  ///< Slip angle of the axle, with the sign of the lateral force [rad].
  /// Derivative of the axle's lateral force with respect to the slip angle, at constant
  /// longitudinal force [N/rad], > 0.
  double stiffness = 0.0;
};

/// Computes slip and stiffness of an axle by the brush model with isotropic stiffness and friction
/// (Pacejka 2012, ch. 3), for small slip. At the slip sigma, the force in the direction of the slip
/// is F = C sigma (1 - q + q^2/3) with the slip stiffness C and q = C sigma/(3 mu F_z). If q
/// reaches 1, the tyre force F reaches the friction force mu F_z. Solving the brush model's force
/// law F(q) for q gives
///   q = 1 - cbrt(1 - F/(mu F_z)),  S = C (1 - q + q^2/3),  T = C (1 - q)^2
/// with the secant stiffness S = F/sigma and the tangent stiffness T = dF/dsigma. The slip angle of
/// the axle is the lateral force divided by the secant stiffness S. At constant longitudinal force,
/// the lateral stiffness is S T/(S c^2 + T (1 - c^2)), with the secant stiffness S, the tangent
/// stiffness T and the ratio c of the lateral force to the total force F.
///
/// The parameter `stiffness` is the slip stiffness C [N/rad], and `friction_force` is mu F_z [N];
/// both must be > 0. Forces of more than 0.95 mu F_z are scaled down to 0.95 mu F_z, because a
/// sliding axle has no stiffness.
AxleOperation BrushAxleAt(double stiffness, double friction_force, const AxleForces& forces);

}  // namespace trackbed
