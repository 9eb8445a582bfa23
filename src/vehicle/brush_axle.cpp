#include "src/vehicle/brush_axle.h"

#include <algorithm>
#include <cmath>

namespace trackbed {

AxleOperation BrushAxleAt(double stiffness, double friction_force, const AxleForces& forces) {
  constexpr double kMaxFrictionUse = 0.95;
  const double force = std::hypot(forces.longitudinal, forces.lateral);
  if (force == 0.0) {
    return {.slip = 0.0, .stiffness = stiffness};
  }
  const double use = std::min(force / friction_force, kMaxFrictionUse);
  const double cosine = forces.lateral / force;
  const double q = 1.0 - std::cbrt(1.0 - use);
  const double secant = stiffness * (1.0 - q + q * q / 3.0);
  const double tangent = stiffness * (1.0 - q) * (1.0 - q);
  const double square = cosine * cosine;
  return {.slip = cosine * use * friction_force / secant,
          .stiffness = secant * tangent / (secant * square + tangent * (1.0 - square))};
}

}  // namespace trackbed
