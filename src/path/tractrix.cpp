#include "trackbed/path/tractrix.h"

#include <cmath>

#include "trackbed/core/angle.h"

namespace trackbed {

double YawAlongTractrix(double yaw, const Vec2& along, double ahead) {
  const double line = std::atan2(along.y(), along.x());
  const double angle = AngleDifference(line, yaw);
  return line - 2.0 * std::atan(std::tan(0.5 * angle) * std::exp(-along.norm() / ahead));
}

}  // namespace trackbed
