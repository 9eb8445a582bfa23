#include "trackbed/planning/common/path_pieces.h"

#include <cmath>

namespace trackbed {

double SteeringSlope(const VehicleParams& vehicle, double curvature, double sharpness) {
  const double tangent = vehicle.wheelbase * curvature;
  return vehicle.wheelbase * std::abs(sharpness) / (1.0 + tangent * tangent);
}

}  // namespace trackbed
