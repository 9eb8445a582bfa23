#include "trackbed/vehicle/steering_reach.h"

#include <algorithm>

namespace trackbed {

double SteeringReach(const VehicleParams& params, double side) {
  const SteeringResponse& response = params.steering_response;
  if (response.curve.empty()) {
    return params.steering_limit;
  }
  const double play = 0.5 * response.backlash;
  const double left = std::min(params.steering_limit, response.curve.back().y() - play);
  const double right = std::min(params.steering_limit, -response.curve.front().y() - play);
  if (left <= 0.0 || right <= 0.0) {
    return params.steering_limit;
  }
  return side > 0.0 ? left : side < 0.0 ? right : std::min(left, right);
}

}  // namespace trackbed
