#pragma once

#include "trackbed/options/key_visitor.h"

namespace trackbed {

/// The lateral forces of the axles in the model of LqrOptions and MpcOptions.
enum class TyreForces {
  kNone,  ///< does not slip: the kinematic car, whatever coefficients it has
  /// In proportion to the slip angle, with the stiffness at the static loads, at the present speed.
  kLinear,
  /// By the brush model (Pacejka 2012, ch. 3), about the planned lateral and longitudinal
  /// acceleration: stiffness and friction in proportion to the axle's load, which braking and
  /// driving shift, and less of both beside the braking or driving force. The turns ahead are those
  /// at their planned speeds. Road of factor 1; drag is left out. The same as kLinear for a car
  /// whose friction or axle loads are not known.
  kBrush,
};
void Visit(KeyVisitor& keys, TyreForces& forces);

}  // namespace trackbed
