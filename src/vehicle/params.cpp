#include "trackbed/vehicle/params.h"

#include <algorithm>
#include <cmath>

#include "trackbed/vehicle/steering_reach.h"

namespace trackbed {

double VehicleParams::min_turning_radius() const {
  return wheelbase / std::tan(SteeringReach(*this, 0.0));
}

double AccelerationLimit::At(double friction) const {
  double largest = by_force;
  for (const AxleGrip& axle : axles) {
    const double pushed = axle.force - friction * axle.transfer;
    if (pushed > 0.0) {
      largest = std::min(largest, friction * kGravity * axle.weight / pushed);
    }
  }
  return std::max(0.0, largest);
}

double MaxDeceleration(const VehicleParams& params, double road) {
  return params.braking.axles.empty() ? params.max_deceleration * std::min(1.0, road)
                                      : params.braking.At(road * params.friction_longitudinal);
}

double MaxAcceleration(const VehicleParams& params, double road) {
  return params.driving.axles.empty() ? params.max_acceleration * std::min(1.0, road)
                                      : params.driving.At(road * params.friction_longitudinal);
}

double MaxLateralAcceleration(const VehicleParams& params, double road) {
  return params.friction_lateral * kGravity * road;
}

double SteeringForCurvature(const VehicleParams& params, double curvature) {
  return std::atan(params.wheelbase * curvature);
}

double CurvatureForSteering(const VehicleParams& params, double steering) {
  return std::tan(steering) / params.wheelbase;
}

double RestingSteering(const VehicleParams& params, double command) {
  const SteeringResponse& response = params.steering_response;
  const auto after_curve = [&](double input) {
    return response.curve.empty() ? input : MonotoneCurve(response.curve).At(input);
  };
  const double center = after_curve(command);
  const double play = 0.5 * response.backlash;
  const double angle = std::clamp(after_curve(0.0), center - play, center + play);
  return std::clamp(angle, -params.steering_limit, params.steering_limit);
}

FrontAngles AckermannAngles(const VehicleParams& params, double steering) {
  const double k = params.track_front / (2.0 * params.wheelbase);
  const double sine = std::sin(steering);
  const double cosine = std::cos(steering);
  // In a left turn, the left wheel is the inner wheel. The angle of the inner front wheel has the
  // cotangent cot(delta) - 0.5 track/wheelbase, where delta is the steering angle of the bicycle
  // model.
  return {std::atan2(sine, cosine - k * sine), std::atan2(sine, cosine + k * sine)};
}

FrontAngles AckermannSlopes(const VehicleParams& params, double steering) {
  const double k = params.track_front / (2.0 * params.wheelbase);
  const double sine = std::sin(steering);
  const double cosine = std::cos(steering);
  const auto slope = [&](double side) {
    const double across = cosine - side * k * sine;
    return 1.0 / (sine * sine + across * across);
  };
  return {slope(1.0), slope(-1.0)};
}

double BicycleAngle(const VehicleParams& params, const FrontAngles& front) {
  const double k = params.track_front / (2.0 * params.wheelbase);
  const auto seen_from = [k](double angle, double side) {
    return std::atan2(std::sin(angle), std::cos(angle) + side * k * std::sin(angle));
  };
  return 0.5 * (seen_from(front.left, 1.0) + seen_from(front.right, -1.0));
}

AxleSpeeds AxleSpeedsFor(const VehicleParams& params, double speed, double steering) {
  const double yaw_rate = speed * CurvatureForSteering(params, steering);
  return {speed - yaw_rate * 0.5 * params.track_rear, speed + yaw_rate * 0.5 * params.track_rear};
}

}  // namespace trackbed
