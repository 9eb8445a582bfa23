#pragma once

#include "trackbed/options/key_visitor.h"

namespace trackbed {

/// The lateral forces of the axles in the model of LqrOptions and MpcOptions.
enum class TyreForces {
  /// No slip: the model is the kinematic car, even if the car has tyre coefficients.
  kNone,
  /// Lateral forces proportional to the slip angle, with the stiffness at the static loads and the
  /// present speed.
  kLinear,
  /// Brush model (Pacejka 2012, ch. 3), linearized at the planned lateral and longitudinal
  /// acceleration. Stiffness and friction are proportional to the axle's load, which braking and
  /// driving shift. The braking or driving force reduces stiffness and friction. Turns ahead are
  /// evaluated at their planned speeds. The model assumes a friction factor of 1 and no drag. The
  /// brush model equals kLinear for a car with unknown friction or axle loads.
  kBrush,
};
void Visit(KeyVisitor& keys, TyreForces& forces);

}  // namespace trackbed
