#include "trackbed/planning/common/lead_in.h"

#include <algorithm>
#include <cmath>

#include "src/planning/common/feasible_speeds.h"
#include "trackbed/planning/common/road_hold.h"

namespace trackbed {
namespace {

/// Largest steering angle that counts as straight ahead [rad].
constexpr double kStraightSteering = 1e-9;

/// Returns the path of a car whose wheels turn at their full rate from the start steering delta_0
/// to straight ahead, over the distance S. The steering angle is delta(s) = delta_0 (1 - s/S). With
/// the wheelbase L, the heading is psi(s) = S/(L delta_0) ln(cos delta(s)/cos delta_0).
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

/// Returns the length of a straight from a pose on which a car at the start speed slows down to
/// `speed` [m]. On a slippery road, the car brakes with the share kBendShares of the grip, because
/// a plan with a bend on this road may use no larger share.
double BrakingLength(const PlanRequest& request, const Pose2& from, double speed) {
  const double deceleration = request.speed.deceleration;
  const double squares = std::max(0.0, request.start_speed * request.start_speed - speed * speed);
  const double shortest = squares / (2.0 * deceleration);
  const RoadHold road(request);
  constexpr double kLongest = 50.0;  // Largest multiple of the shortest braking distance.
  const Path straight(from, {{.length = kLongest * shortest + feasible_speeds::kCheckSpacing}});
  const auto braking = [&](double s) {
    const double grip = road.Braking(straight, s);
    return grip > 0.0 ? std::min(deceleration, feasible_speeds::kBendShares.braking * grip)
                      : deceleration;
  };
  if (road.uniform()) {
    return squares / (2.0 * braking(0.0));
  }
  double left = squares;
  double s = 0.0;
  double before = braking(s);
  while (left > 0.0 && s < kLongest * shortest) {
    const double after = braking(s + feasible_speeds::kCheckSpacing);
    const double least = std::min(before, after);
    // End the loop after the last step: subtracting this step, too, could leave a tiny rest due to
    // rounding, and the loop might not end.
    if (const double rest = left / (2.0 * least); rest <= feasible_speeds::kCheckSpacing) {
      return s + rest;
    }
    left -= 2.0 * least * feasible_speeds::kCheckSpacing;
    s += feasible_speeds::kCheckSpacing;
    before = after;
  }
  return s;
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
  const Path straightening(request.start, lead.segments);
  const Pose2 behind = straightening.At(straightening.length()).pose;
  const double straight = BrakingLength(request, behind, speed) + beyond;
  if (straight > 0.0) {
    lead.segments.push_back({.length = straight});
  }
  const Path path(request.start, lead.segments);
  lead.length = path.length();
  lead.end = path.At(lead.length).pose;
  return lead;
}

std::vector<std::vector<Vec2>> DeparturePolylines(const PlanRequest& request) {
  const double radius = request.vehicle.min_turning_radius();
  const double braking = BrakingLength(request, request.start, 0.0);
  const Vec2 ahead = Direction(request.start.yaw);
  const Vec2 from = request.start.position();
  std::vector<std::vector<Vec2>> ways;
  for (const double radii : {0.5, 1.0, 2.0}) {
    ways.push_back({from, from + (braking + radii * radius) * ahead});
  }
  for (const double radii : {1.5, 2.5}) {
    for (const double side : {1.0, -1.0}) {
      // Add polylines with one quarter turn and with two quarter turns.
      const Vec2 corner = from + (braking + radii * radius) * ahead;
      const Vec2 beside = corner + 2.0 * side * radii * radius * LeftNormal(ahead);
      ways.push_back({from, corner, beside});
      ways.push_back({from, corner, beside, beside - 2.0 * radii * radius * ahead});
    }
  }
  return ways;
}

}  // namespace trackbed
