#include "trackbed/core/angle.h"

#include <cmath>

namespace trackbed {

double WrapAngle(double angle) {
  if (angle > -kPi && angle <= kPi) {
    return angle;
  }
  // std::remainder returns an angle in [-pi, pi].
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

double AngleDifference(double a, double b) {
  return WrapAngle(a - b);
}

}  // namespace trackbed
