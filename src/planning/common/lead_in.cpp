#include "trackbed/planning/common/lead_in.h"

#include <algorithm>
#include <cmath>

namespace trackbed {
namespace {

/// Largest steering angle that counts as straight ahead [rad].
constexpr double kStraightSteering = 1e-9;

/// Returns the path of a car whose wheels turn at their full rate from the start steering delta_0
/// to straight ahead, over the distance S. The steering angle is delta(s) = delta_0 (1 - s/S). The
/// heading is psi(s) = S/(L delta_0) ln(cos delta(s)/cos delta_0).
std::vector<Segment> Straightening(const PlanRequest& request) {
  const VehicleParams& vehicle = request.vehicle;
  const double steering = request.start_steering;
  const double distance = SteeringDistance(vehicle, steering, request.start_speed);
  constexpr double kSpacing = 0.1;  // [m]
  const auto intervals = static_cast<int>(std::ceil(distance / kSpacing));
  std::vector<CurvePoint> points;
  for (int i = 0; i <= intervals; ++i) {
    const double share = static_cast<double>(i) / intervals;
    const double delta = steering * (1.0 - share);
    points.push_back({.s = share * distance,
                      .yaw = distance / (vehicle.wheelbase * steering) *
                             std::log(std::cos(delta) / std::cos(steering)),
                      .curvature = CurvatureForSteering(vehicle, delta)});
  }
  return SegmentsThrough(points);
}

}  // namespace

LeadIn ComputeLeadIn(const PlanRequest& request, double speed, double beyond) {
  LeadIn lead{.segments = {}, .end = request.start};
  if (request.start_speed <= 0.0) {
    return lead;
  }
  if (std::abs(request.start_steering) > kStraightSteering) {
    lead.segments = Straightening(request);
  }
  const double v = request.start_speed;
  const double straight =
      std::max(0.0, v * v - speed * speed) / (2.0 * request.speed.deceleration) + beyond;
  if (straight > 0.0) {
    lead.segments.push_back({.length = straight});
  }
  const Path path(request.start, lead.segments);
  lead.length = path.length();
  lead.end = path.At(lead.length).pose;
  return lead;
}

}  // namespace trackbed
