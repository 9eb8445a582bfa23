#pragma once

#include "trackbed/options/key_visitor.h"

namespace trackbed {

/// Selects how the vehicle model of LQR and MPC (LqrOptions, MpcOptions) computes the lateral
/// forces of the axles.
enum class TyreForces {
  /// The tyres do not slip: the model is the kinematic car, even if the car has tyre coefficients.
  kNone,
  /// The lateral forces are proportional to the slip angles, with the cornering stiffness at the
  /// static loads. The model is linearized at the car's present speed.
  kLinear,
  /// Brush model (Pacejka 2012, ch. 3), linearized at the planned lateral and longitudinal
  /// acceleration. Stiffness and friction force are proportional to the axle's load, which shifts
  /// during braking and driving. The braking or driving force reduces the lateral stiffness and the
  /// available lateral friction. Turns ahead of the car are evaluated at their planned speeds. The
  /// model assumes a friction factor of 1 and no drag. The brush model equals kLinear for a car
  /// with unknown friction or axle loads.
  kBrush,
};
void Visit(KeyVisitor& keys, TyreForces& forces);

}  // namespace trackbed
