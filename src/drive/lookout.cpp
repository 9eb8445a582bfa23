#include "src/drive/lookout.h"

#include <algorithm>
#include <cmath>

#include "trackbed/planning/avoidance.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

constexpr double kSameTime = 1e-9;  // [s]
/// Slower than this a car is at rest [m/s].
constexpr double kAtRest = 0.01;
/// Further beside its plan than this, or turned or faster by this much, a car has strayed from it.
constexpr double kStrayed = 0.5;         // [m]
constexpr double kStrayedHeading = 0.2;  // [rad]
constexpr double kStrayedSpeed = 1.0;    // [m/s]

}  // namespace

bool IsForAvoider(const PlanSpec& spec, const VehicleParams& vehicle, const Path& path,
                  double station, const OrientedBox& obstacle) {
  if (!spec.avoid || !spec.replan) {
    return spec.avoid.has_value();
  }
  const double distance =
      std::visit([](const auto& options) { return options.safe_distance; }, *spec.avoid);
  return StandsInTurn(vehicle, path, station, obstacle, distance);
}

SpeedLimits SpeedLimitsOf(const Scenario& scenario) {
  const SpeedControlOptions& speed = scenario.control.speed;
  return {SpeedOf(scenario), speed.acceleration, speed.deceleration};
}

Lookout::Lookout(const Scenario& scenario, const VehicleParams& vehicle, const Plan& plan)
    : scenario_(scenario), vehicle_(vehicle), seen_(scenario.world.obstacles.size()) {
  if (scenario.plan && scenario.plan->replan) {
    SetRoute(plan);
  }
}

std::optional<Plan> Lookout::Look(const VehicleState& state, const Plan& plan,
                                  const Projection& at) {
  if (!scenario_.plan) {
    return std::nullopt;
  }
  See(state);
  if (scenario_.plan->avoid && driving_.on_route) {
    if (std::optional<Plan> around = Avoid(state, plan, at.s)) {
      return around;
    }
  }
  return scenario_.plan->replan ? PlanAgain(state, plan, at) : std::nullopt;
}

bool Lookout::Waits() const {
  return scenario_.plan && scenario_.plan->replan && !driving_.plan.blocked.empty() && !gave_up_;
}

void Lookout::See(const VehicleState& state) {
  const OrientedBox outline = OutlineAt(vehicle_, state.pose);
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    Seen& seen = seen_[i];
    if (!seen.since && IsKnown(scenario_.world.obstacles[i], state.time, outline)) {
      seen.since = state.time;
      seen.taken_in = state.time == 0.0;  // the mission's plan was made with it
    }
  }
}

std::optional<Plan> Lookout::Avoid(const VehicleState& state, const Plan& plan, double station) {
  const auto [delay, distance] = std::visit(
      [](const auto& options) { return std::pair(options.delay, options.safe_distance); },
      *scenario_.plan->avoid);
  AvoidanceRequest request{.vehicle = vehicle_,
                           .plan = plan,
                           .speed = SpeedLimitsOf(scenario_),
                           .obstacles = {},
                           .station = station,
                           .station_speed = std::abs(state.speed),
                           .car = AvoidanceRequest::Car{state.pose, state.steering},
                           .seed = scenario_.seed};
  const auto is_due = [&](const Seen& seen) {
    return seen.since && !seen.taken_in && state.time >= *seen.since + delay - kSameTime;
  };
  if (std::none_of(seen_.begin(), seen_.end(), is_due)) {
    return std::nullopt;
  }
  bool in_the_way = false;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const bool due = is_due(seen_[i]);
    seen_[i].taken_in = seen_[i].taken_in || due;
    const OrientedBox box = FootprintAt(scenario_.world.obstacles[i], state.time);
    const Path& path = plan.reference.path;
    if (seen_[i].taken_in && IsForAvoider(*scenario_.plan, vehicle_, path, station, box)) {
      request.obstacles.push_back(box);
      in_the_way = in_the_way || (due && IsInTheWay(vehicle_, path, station, box, distance));
    }
  }
  if (!in_the_way) {
    return std::nullopt;
  }
  Plan around = PlanAround(request, *scenario_.plan->avoid);
  if (scenario_.plan->replan) {
    if (!around.blocked.empty()) {
      return std::nullopt;  // no curve leads past: something else may
    }
    SetRoute(around);
  }
  return around;
}

void Lookout::SetRoute(const Plan& plan) {
  const SpeedLimits speed = SpeedLimitsOf(scenario_);
  const double reach = speed.speed * scenario_.plan->replan->settings.look_ahead;
  driving_.route = plan;
  driving_.frame = FrameOf(vehicle_, plan, speed, 2.0 * reach);
  driving_.plan = plan;
  driving_.on_route = true;
  driving_.station = 0.0;
  driving_.route_station = 0.0;
}

std::optional<Plan> Lookout::PlanAgain(const VehicleState& state, const Plan& plan,
                                       const Projection& at) {
  const ReplanOptions& options = *scenario_.plan->replan;
  const double speed = std::abs(state.speed);
  if (state.time < static_cast<double>(looks_) * options.period - kSameTime) {
    return std::nullopt;
  }
  // Where the car is on the route, looked for near where it can have got to since the last look.
  constexpr double kSearch = 3.0;  // [m]
  driving_.route_station =
      driving_.route.reference.path
          .Project(state.pose, {driving_.route_station - kSearch,
                                driving_.route_station + kSearch + 2.0 * speed * options.period})
          .s;
  driving_.plan = plan;
  driving_.station = at.s;
  ReplanRequest request{
      .vehicle = vehicle_,
      .speed = SpeedLimitsOf(scenario_),
      .wind = scenario_.world.wind,
      .time = state.time,
      .car = {.pose = state.pose,
              .curvature = CurvatureForSteering(vehicle_, state.steering),
              .speed = speed},
      .strayed = std::abs(at.cross_track) > kStrayed ||
                 std::abs(at.heading_error) > kStrayedHeading ||
                 std::abs(plan.reference.speed.SpeedAt(at.s) - speed) > kStrayedSpeed,
      .obstacles = {},
      .seed = scenario_.seed + static_cast<std::uint64_t>(looks_) * 1000};
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const Obstacle& obstacle = scenario_.world.obstacles[i];
    if (!seen_[i].since) {
      continue;
    }
    const OrientedBox box = FootprintAt(obstacle, state.time);
    // The avoider gets its delay first; what it finds no way around is for here after all.
    const bool for_avoider =
        !seen_[i].taken_in && driving_.on_route &&
        IsForAvoider(*scenario_.plan, vehicle_, plan.reference.path, at.s, box);
    if (!for_avoider) {
      request.obstacles.push_back({box, obstacle.velocity});
    }
  }
  ++looks_;
  Replanned next = Replan(request, driving_, options);
  constexpr double kNowhere = 0.1;  // [m]
  const bool moves = next.kind != ReplanKind::kKeep && next.plan.reference.path.length() > kNowhere;
  gave_up_ = speed < kAtRest && !moves &&
             !MayClear(vehicle_, driving_.route.reference.path, driving_.route_station,
                       request.obstacles, options.settings.safe_distance);
  if (next.kind == ReplanKind::kKeep) {
    return std::nullopt;
  }
  if (next.kind == ReplanKind::kRoute) {
    SetRoute(next.plan);
  } else {
    driving_.plan = next.plan;
    driving_.on_route = false;
  }
  return std::move(next.plan);
}

}  // namespace trackbed
