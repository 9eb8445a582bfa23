#include "src/drive/lookout.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/plan.h"
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

std::vector<MovingBox> Lookout::Known(const VehicleState& state, const Path& path,
                                      double station) const {
  std::vector<MovingBox> known;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const Obstacle& obstacle = scenario_.world.obstacles[i];
    if (!seen_[i].since) {
      continue;
    }
    const OrientedBox box = FootprintAt(obstacle, state.time);
    // The avoider gets its delay first; what it finds no way around is for here after all.
    const bool for_avoider = !seen_[i].taken_in && driving_.on_route &&
                             IsForAvoider(*scenario_.plan, vehicle_, path, station, box);
    if (!for_avoider) {
      known.push_back({box, obstacle.velocity});
    }
  }
  return known;
}

bool Lookout::IsUrgent(const VehicleState& state, const Plan& plan, const Projection& at) const {
  const bool news = std::any_of(seen_.begin(), seen_.end(), [&](const Seen& seen) {
    return seen.since && *seen.since == state.time;
  });
  if (!news) {
    return false;
  }
  const ReplanOptions& options = *scenario_.plan->replan;
  const double speed = std::abs(state.speed);
  // Comfortable braking from the next look on, and a car's length to spare.
  const double stop = speed * options.period +
                      0.5 * speed * speed / SpeedLimitsOf(scenario_).deceleration + vehicle_.length;
  const auto encounter =
      FirstEncounter(vehicle_, plan.reference, at.s, Known(state, plan.reference.path, at.s),
                     options.settings.safe_distance, options.settings.look_ahead, at.cross_track);
  return encounter && encounter->station - at.s < stop;
}

double Lookout::HardestBraking(const Path& path, double station, double speed) const {
  constexpr double kSpacing = 1.0;  // [m]
  constexpr double kLeast = 0.1;    // [m/s^2]
  double hardest = MaxDeceleration(vehicle_, 1.0);
  // What is slippery makes it look further.
  for (double ahead = 0.0; hardest > kLeast && 2.0 * hardest * ahead <= speed * speed;
       ahead += kSpacing) {
    const PathPoint at = path.At(station + ahead);
    double road = std::numeric_limits<double>::infinity();
    for (const Vec2& corner : OutlineAt(vehicle_, at.pose).Corners()) {
      road = std::min(road, RoadFactor(scenario_.world, corner));
    }
    const double grip = MaxDeceleration(vehicle_, road);
    // What a bend takes of the tyres, at the speed that is left there, leaves the rest of the
    // ellipse: a third at least, for a car that is too fast for the bend slides anyway.
    const double across = (speed * speed - 2.0 * hardest * ahead) * std::abs(at.curvature);
    const double most = MaxLateralAcceleration(vehicle_, road);
    const double rest =
        most > 0.0 ? std::sqrt(std::max(0.1, 1.0 - std::pow(across / most, 2))) : 1.0;
    const Eigen::Vector3d normal = GroundNormal(scenario_.world, at.pose.position());
    const double downhill = normal.head<2>().dot(Direction(at.pose.yaw)) / normal.z();
    hardest = std::min(hardest, grip * rest - kGravity * std::max(0.0, downhill));
  }
  return vehicle_.max_deceleration > 0.0 ? std::max(hardest, kLeast) : 0.0;
}

std::optional<Plan> Lookout::PlanAgain(const VehicleState& state, const Plan& plan,
                                       const Projection& at) {
  const ReplanOptions& options = *scenario_.plan->replan;
  const double speed = std::abs(state.speed);
  const bool due = state.time >= static_cast<double>(looks_) * options.period - kSameTime;
  if (!due && !IsUrgent(state, plan, at)) {
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
      .max_deceleration = HardestBraking(plan.reference.path, at.s, speed),
      .obstacles = Known(state, plan.reference.path, at.s),
      .seed = scenario_.seed + static_cast<std::uint64_t>(looks_) * 1000};
  looks_ += due ? 1 : 0;
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
