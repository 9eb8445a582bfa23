#pragma once

#include "trackbed/options/key_visitor.h"

namespace trackbed {

/// The lateral forces of the axles in the model of LqrOptions and MpcOptions.
enum class TyreForces {
  kNone,  ///< no slip: the kinematic car, for any tyre coefficients
  /// Proportional to the slip angle, with the stiffness at the static loads, at the present speed.
  kLinear,
  /// Brush model (Pacejka 2012, ch. 3), linearized at the planned lateral and longitudinal
  /// acceleration. Stiffness and friction are proportional to the axle's load, which braking and
  /// driving shift; the braking or driving force reduces both. Turns ahead are taken at their
  /// planned speeds. Assumes a friction factor of 1 and no drag. Equals kLinear for a car with
  /// unknown friction or axle loads.
  kBrush,
};
void Visit(KeyVisitor& keys, TyreForces& forces);

}  // namespace trackbed
