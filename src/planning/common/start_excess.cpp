#include "src/planning/common/start_excess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/planning/common/feasible_speeds.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/road_hold.h"
#include "trackbed/vehicle/steering_reach.h"

namespace trackbed::start_excess {
namespace {

/// Tolerance of the start position [m]; for a wheelbase below 1 m, multiplied by the wheelbase in
/// meters.
constexpr double kSamePlace = 1e-3;
constexpr double kSameHeading = 1e-3;  // Tolerance of the start heading [rad].
/// Tolerance of the start steering [rad].
constexpr double kSteeringTolerance = 1e-3;

/// Rounds a positive number down to three significant digits.
double RoundDown(double number) {
  if (!(number > 0.0)) {
    return 0.0;
  }
  const double digit = std::pow(10.0, std::floor(std::log10(number)) - 2.0);
  return digit * std::floor(number / digit);
}

std::vector<Excess> Displacement(const Plan& plan, const PlanRequest& request) {
  const Pose2 first = plan.reference.path.At(0.0).pose;
  const double away = (first.position() - request.start.position()).norm();
  const double turned = std::abs(AngleDifference(first.yaw, request.start.yaw));
  const double same_place = kSamePlace * std::min(1.0, request.vehicle.wheelbase);
  constexpr double kRounding = 1.0 + feasible_speeds::kRounding;
  std::vector<Excess> found;
  if (away > same_place * kRounding) {
    found.push_back({.what = "initial position error",
                     .required = away,
                     .limit = same_place,
                     .unit = "m",
                     .hint = fmt::format("the path begins at ({:.10g}, {:.10g}), the car at "
                                         "({:.10g}, {:.10g}); set mission.start.x and y to the "
                                         "path's beginning, or remove them",
                                         first.x, first.y, request.start.x, request.start.y)});
  }
  if (turned > kSameHeading * kRounding) {
    found.push_back({.what = "initial heading error",
                     .required = turned,
                     .limit = kSameHeading,
                     .unit = "rad",
                     .hint = fmt::format("the path begins with a heading of {0:.4g} rad, the car "
                                         "with {1:.4g} rad; set mission.start.yaw: {0:.4g}",
                                         WrapAngle(first.yaw), WrapAngle(request.start.yaw))});
  }
  return found;
}

std::optional<Excess> SteeringStep(const Plan& plan, const PlanRequest& request) {
  const VehicleParams& vehicle = request.vehicle;
  const double fitting = SteeringForCurvature(vehicle, plan.reference.path.At(0.0).curvature);
  const double step = std::abs(fitting - request.start_steering);
  const bool can_steer =
      std::abs(fitting) <= SteeringReach(vehicle, fitting) * (1.0 + feasible_speeds::kRounding);
  if (!(request.start_speed > 0.0) || !can_steer || step <= kSteeringTolerance) {
    return std::nullopt;
  }
  return Excess{.what = "initial steering step",
                .required = step,
                .limit = kSteeringTolerance,
                .unit = "rad",
                .hint = fmt::format(
                    "the path begins with a steering angle of {0:.4g} rad, the car with {1:.4g} "
                    "rad; set mission.start.steering: {0:.4g}, or start at rest with "
                    "mission.start.speed: 0",
                    fitting, request.start_steering)};
}

}  // namespace

std::vector<Excess> At(const Plan& plan, const PlanRequest& request) {
  std::vector<Excess> found = Displacement(plan, request);
  if (std::optional<Excess> step = SteeringStep(plan, request)) {
    found.push_back(std::move(*step));
  }
  return found;
}

Excess TooFast(double start_speed, double highest, const std::string& cause, double station) {
  const double rounded = RoundDown(highest);
  return {.what = "start speed",
          .required = start_speed,
          .limit = rounded,
          .unit = "m/s",
          .station = station,
          .hint = fmt::format("the car cannot slow down in time: {}; set mission.start.speed to at "
                              "most {:.4g}",
                              cause, rounded)};
}

std::optional<Excess> LeftAfterBraking(const Plan& plan, const PlanRequest& request) {
  const double length = plan.reference.path.length();
  if (!(length > 0.0)) {
    return std::nullopt;
  }
  const double squared = request.start_speed * request.start_speed;
  double braking = kMaxBrakingFactor * request.speed.deceleration;
  const RoadHoldLimits hold = MinRoadHold(plan.reference.path, {0.0, length}, request);
  if (hold.braking > 0.0) {
    braking = std::min(braking, hold.braking);
  }
  const double stop = squared / (2.0 * braking);
  Plan hard = plan;
  std::vector<SpeedProfile::Knot> knots{{0.0, request.start_speed}};
  if (stop < length) {
    knots.push_back({stop, 0.0});
  }
  knots.push_back({length, std::sqrt(std::max(0.0, squared - 2.0 * braking * length))});
  hard.reference.speed = SpeedProfile(std::move(knots));
  hard.schedule_speed = hard.reference.speed;
  std::optional<Excess> worst;
  for (Excess& excess : FindExcesses(hard, request)) {
    if (excess.remedy == Remedy::kLowerSpeed &&
        (!worst || excess.required * worst->limit > worst->required * excess.limit)) {
      worst = std::move(excess);
    }
  }
  return worst;
}

}  // namespace trackbed::start_excess
