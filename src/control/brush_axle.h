#pragma once

namespace trackbed {

/// Forces of an axle on the road.
struct AxleForces {
  double longitudinal = 0.0;  ///< [N]
  double lateral = 0.0;       ///< [N]
};

/// An axle about an operating point.
struct AxleOperation {
  double slip = 0.0;       ///< angle [rad] with the sign of the lateral force
  double stiffness = 0.0;  ///< d lateral/d slip while the longitudinal force stays [N/rad], > 0
};

/// The brush model with isotropic stiffness and friction (Pacejka 2012, ch. 3), at small slip: at
/// the slip sigma, F = C sigma (1 - q + q^2/3) with q = C sigma/(3 mu F_z), which reaches mu F_z at
/// q = 1, in the direction of the slip. Inverted,
///   q = 1 - cbrt(1 - F/(mu F_z)),  S = C (1 - q + q^2/3),  T = C (1 - q)^2
/// with the secant stiffness S = F/sigma and the tangent T = dF/dsigma. The slip angle is
/// lateral/S, and the lateral stiffness beside a fixed longitudinal force
/// S T/(S c^2 + T (1 - c^2)) with c = lateral/F.
///
/// C `stiffness` [N/rad] and `friction_force` mu F_z [N], both > 0. Forces of more than 0.95 mu F_z
/// are reduced to that, in their direction: a sliding axle has no stiffness.
AxleOperation BrushAxleAt(double stiffness, double friction_force, const AxleForces& forces);

}  // namespace trackbed
