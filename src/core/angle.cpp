#include "trackbed/core/angle.h"

#include <cmath>

namespace trackbed {

double WrapAngle(double angle) {
  if (angle > -kPi && angle <= kPi) {
    return angle;
  }
  const double wrapped = std::remainder(angle, 2.0 * kPi);  // in the interval [-pi, pi]
  return wrapped <= -kPi ? kPi : wrapped;
}

double AngleDifference(double a, double b) {
  return WrapAngle(a - b);
}

}  // namespace trackbed
