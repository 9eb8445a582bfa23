#include "trackbed/planning/common/road_hold.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/world/world.h"

namespace trackbed {
namespace {

/// Reduces the acceleration `grip` [m/s^2] by the component of gravity that acts against it, a
/// fraction `against` of g. A `grip` of 0 means that the grip is unknown, and stays 0.
double SubtractGravity(double grip, double against) {
  return std::max(0.0, grip - kGravity * std::max(0.0, against));
}

}  // namespace

RoadHold::RoadHold(const PlanRequest& request) : request_(request), flat_(IsFlat(request.ground)) {}

double RoadHold::Factor(const Pose2& pose) const {
  if (request_.friction_patches.empty()) {
    return request_.friction;
  }
  const auto factor = [&](const Vec2& point) {
    return RoadFactor(request_.friction, request_.friction_patches, point);
  };
  return std::min(factor(pose.position()),
                  factor(ToWorld(pose, {request_.vehicle.wheelbase, 0.0})));
}

RoadHold::Tilt RoadHold::TiltAt(const PathPoint& at) const {
  if (flat_) {
    return {};
  }
  const Vec2 rear = at.pose.position();
  const Vec2 forward = Direction(at.pose.yaw);
  const bool two_axles = request_.vehicle.kind == VehicleKind::kSteered;
  const double wheelbase = request_.vehicle.wheelbase;
  const Vec2 front = two_axles ? Vec2(rear + wheelbase * forward) : rear;
  const Vec2 slope =
      0.5 * (GroundSlope(request_.ground, rear) + GroundSlope(request_.ground, front));
  // Compute the pitch from the height difference of the axles, so that bumps shorter than the
  // wheelbase are averaged.
  const double along =
      two_axles
          ? (GroundHeight(request_.ground, front) - GroundHeight(request_.ground, rear)) / wheelbase
          : slope.dot(forward);
  const double across = slope.dot(LeftNormal(forward));
  return {.load = 1.0 / std::sqrt(1.0 + along * along + across * across),
          .up = at.direction * along / std::hypot(1.0, along),
          .left = across / std::hypot(1.0, across)};
}

double RoadHold::FrictionAt(const Path& path, double s) const {
  if (uniform()) {
    return request_.friction;
  }
  const PathPoint at = path.At(s);
  return Factor(at.pose) * TiltAt(at).load;
}

double RoadHold::Lateral(const Path& path, double s, double curvature) const {
  if (uniform()) {
    return MaxLateralAcceleration(request_.vehicle, request_.friction);
  }
  const PathPoint at = path.At(s);
  const Tilt tilt = TiltAt(at);
  // With a positive curvature, the center of the turn is to the left in both gears.
  const double against = curvature > 0.0   ? tilt.left
                         : curvature < 0.0 ? -tilt.left
                                           : std::abs(tilt.left);
  return SubtractGravity(MaxLateralAcceleration(request_.vehicle, Factor(at.pose) * tilt.load),
                         against);
}

double RoadHold::BesideSlope(double along, double road, const Tilt& tilt) const {
  const double grip_along = request_.vehicle.friction_longitudinal * kGravity * road;
  const double grip_across = MaxLateralAcceleration(request_.vehicle, road);
  if (!(grip_along > 0.0) || !(grip_across > 0.0)) {
    return along;
  }
  const double share = std::min(1.0, kGravity * std::abs(tilt.left) / grip_across);
  return std::min(along, grip_along * std::sqrt(1.0 - share * share));
}

double RoadHold::Braking(const Path& path, double s) const {
  if (uniform()) {
    return MaxDeceleration(request_.vehicle, request_.friction);
  }
  const PathPoint at = path.At(s);
  const Tilt tilt = TiltAt(at);
  const double road = Factor(at.pose) * tilt.load;
  return SubtractGravity(BesideSlope(MaxDeceleration(request_.vehicle, road), road, tilt),
                         -tilt.up);
}

double RoadHold::Driving(const Path& path, double s) const {
  if (uniform()) {
    return MaxAcceleration(request_.vehicle, request_.friction);
  }
  const PathPoint at = path.At(s);
  const Tilt tilt = TiltAt(at);
  const double road = Factor(at.pose) * tilt.load;
  return SubtractGravity(BesideSlope(MaxAcceleration(request_.vehicle, road), road, tilt), tilt.up);
}

RoadHold::Demand RoadHold::DemandAt(const Path& path, double s, double along, double side) const {
  const PathPoint at = uniform() ? PathPoint{} : path.At(s);
  const Tilt tilt = TiltAt(at);
  const double road = uniform() ? request_.friction : Factor(at.pose) * tilt.load;
  const double up = along < 0.0 ? -tilt.up : tilt.up;
  const double left = side < 0.0 ? -tilt.left : tilt.left;
  return {.grip_along = request_.vehicle.friction_longitudinal * kGravity * road,
          .grip_across = MaxLateralAcceleration(request_.vehicle, road),
          .along = std::abs(along) + kGravity * std::max(0.0, up),
          .pull_across = kGravity * std::max(0.0, left)};
}

RoadHold::Combined RoadHold::Both(const Path& path, double s, double along, double across) const {
  const Demand demand = DemandAt(path, s, along, across);
  if (!demand.is_known()) {
    return {};
  }
  const double across_demand = std::abs(across) + demand.pull_across;
  const double required = std::hypot(demand.along, across_demand);
  const double share =
      std::hypot(demand.along / demand.grip_along, across_demand / demand.grip_across);
  return {required, share > 0.0 ? required / share : 0.0};
}

double RoadHold::LateralBeside(const Path& path, double s, double curvature, double along) const {
  const Demand demand = DemandAt(path, s, along, curvature);
  if (!demand.is_known()) {
    return std::numeric_limits<double>::infinity();
  }
  const double share = demand.along / demand.grip_along;
  return demand.grip_across * std::sqrt(std::max(0.0, 1.0 - share * share)) - demand.pull_across;
}

RoadHold::Pull RoadHold::Slope(const Path& path, double s) const {
  if (flat_) {
    return {};
  }
  const PathPoint at = path.At(s);
  const Tilt tilt = TiltAt(at);
  const double road = Factor(at.pose) * tilt.load;
  const Pull along{kGravity * std::abs(tilt.up), tilt.up < 0.0
                                                     ? MaxDeceleration(request_.vehicle, road)
                                                     : MaxAcceleration(request_.vehicle, road)};
  const Pull across{kGravity * std::abs(tilt.left), MaxLateralAcceleration(request_.vehicle, road)};
  const double grip_along = request_.vehicle.friction_longitudinal * kGravity * road;
  const double share = grip_along > 0.0 && across.hold > 0.0
                           ? std::hypot(along.pull / grip_along, across.pull / across.hold)
                           : 0.0;
  const double steepest = std::hypot(along.pull, across.pull);
  const Pull total{steepest, share > 0.0 ? steepest / share : 0.0};
  const auto ratio = [](const Pull& each) { return each.hold > 0.0 ? each.pull / each.hold : 0.0; };
  return std::max({across, along, total},
                  [&](const Pull& a, const Pull& b) { return ratio(a) < ratio(b); });
}

RoadHoldLimits MinRoadHold(const Path& path, Stations within, const PlanRequest& request) {
  constexpr double kSpacing = 0.1;  // [m]
  const RoadHold road(request);
  const auto at = [&](double s) {
    return RoadHoldLimits{road.Lateral(path, s, 0.0), road.Braking(path, s), road.Driving(path, s)};
  };
  RoadHoldLimits least = at(within.from);
  if (road.uniform()) {
    return least;
  }
  const double count = std::ceil(std::max(0.0, within.to - within.from) / kSpacing);
  for (double i = 1.0; i <= count; i += 1.0) {
    const RoadHoldLimits next = at(std::lerp(within.from, within.to, i / count));
    least = {std::min(least.lateral, next.lateral), std::min(least.braking, next.braking),
             std::min(least.driving, next.driving)};
  }
  return least;
}

}  // namespace trackbed
