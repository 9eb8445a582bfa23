#pragma once

#include "trackbed/options/key_visitor.h"

namespace trackbed {

/// Selects how the vehicle model of LQR and MPC (LqrOptions, MpcOptions) computes the lateral
/// forces of the axles.
enum class TyreForces {
  /// The tyres do not slip, so the model is the kinematic car even if the car has tyre
  /// coefficients.
  kNone,
  /// The lateral forces are proportional to the slip angles, with the cornering stiffnesses at the
  /// static wheel loads.
  kLinear,
  /// The tyres follow the brush model (Pacejka 2012, ch. 3), linearized at the planned lateral and
  /// longitudinal acceleration. The stiffness and the friction force of an axle are proportional to
  /// its load, which changes during braking and driving. The braking or driving force reduces the
  /// lateral stiffness and the available lateral friction. The brush model assumes a road friction
  /// factor of 1 and no
  /// aerodynamic drag. For a car with unknown friction or axle loads, the brush model is the same
  /// as kLinear.
  kBrush,
};
void Visit(KeyVisitor& keys, TyreForces& forces);

}  // namespace trackbed
