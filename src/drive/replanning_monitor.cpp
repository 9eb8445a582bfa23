#include "src/drive/replanning_monitor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/world/world.h"

// ReplanningMonitor decides in every control period whether to plan again:
//   1. Register the obstacles that become known.
//   2. While the car is on its route, call the avoider (a planner around single obstacles), if
//      configured, for obstacles that block the plan in a turn. The avoider is called after its
//      configured delay.
//   3. If the avoider is not called and replanning is configured, replan at multiples of the
//      replanning period. Replan at once if a new obstacle is within stopping distance.
namespace trackbed {
namespace {

constexpr double kSameTime = 1e-9;  // Tolerance for comparing times [s].
/// The following constants are the deviations from the plan beyond which replanning no longer
/// assumes that the car follows the plan.
constexpr double kStrayed = 0.5;  // Largest distance of the car from the plan [m].
// Largest difference between car and plan in heading [rad].
constexpr double kStrayedHeading = 0.2;
constexpr double kStrayedSpeed = 1.0;  // Largest difference between car and plan in speed [m/s].

}  // namespace

bool IsForAvoider(const ReplanningConfig& config, const VehicleParams& vehicle, const Path& path,
                  double station, const OrientedBox& obstacle) {
  if (!config.avoid || !config.replan) {
    return config.avoid.has_value();
  }
  const double distance =
      std::visit([](const auto& options) { return options.safe_distance; }, *config.avoid);
  return StandsInTurn(vehicle, path, station, obstacle, distance);
}

ReplanningMonitor::ReplanningMonitor(const Options& options, const FeasiblePlan& plan)
    : options_(options), knowledge_(options.world.obstacles.size()) {
  if (options_.replanning.replan) {
    SetRoute(plan);
  }
}

std::optional<FeasiblePlan> ReplanningMonitor::Update(const VehicleState& state, const Plan& plan,
                                                      const Projection& at) {
  UpdateKnowledge(state);
  if (options_.replanning.avoid && driving_.on_route) {
    if (std::optional<FeasiblePlan> around = Avoid(state, plan, at.s)) {
      return around;
    }
  }
  return options_.replanning.replan ? ReplanIfDue(state, plan, at) : std::nullopt;
}

bool ReplanningMonitor::IsWaiting() const {
  return options_.replanning.replan && !driving_.plan.blocked.empty() && !gave_up_;
}

void ReplanningMonitor::UpdateKnowledge(const VehicleState& state) {
  const OrientedBox footprint = FootprintAt(options_.vehicle, state.pose);
  for (std::size_t i = 0; i < knowledge_.size(); ++i) {
    Knowledge& known = knowledge_[i];
    if (!known.since && IsKnown(options_.world.obstacles[i], state.time, footprint)) {
      known.since = state.time;
      known.avoided = state.time == 0.0;  // the initial plan already accounts for this obstacle
    }
  }
}

std::optional<FeasiblePlan> ReplanningMonitor::Avoid(const VehicleState& state, const Plan& plan,
                                                     double station) {
  const ReplanningConfig& config = options_.replanning;
  const double delay = std::visit([](const auto& options) { return options.delay; }, *config.avoid);
  const double distance =
      std::visit([](const auto& options) { return options.safe_distance; }, *config.avoid);
  const auto is_due = [&](const Knowledge& known) {
    return known.since && !known.avoided && state.time >= *known.since + delay - kSameTime;
  };
  if (std::none_of(knowledge_.begin(), knowledge_.end(), is_due)) {
    return std::nullopt;
  }
  std::vector<OrientedBox> obstacles;
  bool in_the_way = false;
  for (std::size_t i = 0; i < knowledge_.size(); ++i) {
    Knowledge& known = knowledge_[i];
    const bool due = is_due(known);
    known.avoided = known.avoided || due;
    const OrientedBox box = FootprintAt(options_.world.obstacles[i], state.time);
    const Path& path = plan.reference.path;
    if (known.avoided && IsForAvoider(config, options_.vehicle, path, station, box)) {
      obstacles.push_back(box);
      in_the_way =
          in_the_way || (due && IsInTheWay(options_.vehicle, path, station, box, distance));
    }
  }
  if (!in_the_way) {
    return std::nullopt;
  }
  FeasiblePlan around = PlanAround({.vehicle = options_.vehicle,
                                    .plan = plan,
                                    .speed = config.limits,
                                    .obstacles = std::move(obstacles),
                                    .station = station,
                                    .station_speed = std::abs(state.speed),
                                    .car = AvoidanceRequest::Car{state.pose, state.steering},
                                    .seed = options_.seed,
                                    .road = Road()},
                                   *config.avoid);
  if (config.replan) {
    if (!around->blocked.empty()) {
      return std::nullopt;  // the avoider finds no path, but replanning may find one
    }
    SetRoute(around);
  }
  return around;
}

RoadConditions ReplanningMonitor::Road() const {
  return {.friction = options_.world.friction,
          .friction_patches = options_.world.friction_patches,
          .ground = options_.world.ground,
          .infeasible = options_.replanning.infeasible};
}

void ReplanningMonitor::SetRoute(const Plan& plan) {
  const SpeedLimits speed = options_.replanning.limits;
  const double reach = speed.speed * options_.replanning.replan->settings.look_ahead;
  driving_.route = plan;
  driving_.frame = MakeRouteFrame(options_.vehicle, plan, speed, 2.0 * reach,
                                  options_.replanning.replan->settings.safe_distance);
  driving_.plan = plan;
  driving_.on_route = true;
  driving_.station = 0.0;
  driving_.route_station = 0.0;
}

std::vector<MovingBox> ReplanningMonitor::KnownObstacles(const VehicleState& state,
                                                         const Path& path, double station) const {
  std::vector<MovingBox> known;
  for (std::size_t i = 0; i < knowledge_.size(); ++i) {
    const Obstacle& obstacle = options_.world.obstacles[i];
    if (!knowledge_[i].since) {
      continue;
    }
    const OrientedBox box = FootprintAt(obstacle, state.time);
    // Omit obstacles that the avoider handles first. If the avoider finds no path around an
    // obstacle, replanning handles this obstacle.
    const bool for_avoider =
        !knowledge_[i].avoided && driving_.on_route &&
        IsForAvoider(options_.replanning, options_.vehicle, path, station, box);
    if (!for_avoider) {
      known.push_back({box, MotionAt(obstacle, state.time).velocity});
    }
  }
  for (const OrientedBox& wall : MapWalls(options_.world)) {
    known.push_back({wall, Vec2::Zero()});
  }
  return known;
}

bool ReplanningMonitor::IsUrgent(const VehicleState& state, const Plan& plan,
                                 const Projection& at) const {
  const bool news = std::any_of(knowledge_.begin(), knowledge_.end(), [&](const Knowledge& known) {
    return known.since && *known.since == state.time;
  });
  if (!news) {
    return false;
  }
  const ReplanOptions& options = *options_.replanning.replan;
  const double speed = std::abs(state.speed);
  // Stopping distance of a car that brakes comfortably from the next replanning period on, plus a
  // car length.
  const double stop = speed * options.period +
                      0.5 * speed * speed / options_.replanning.limits.deceleration +
                      options_.vehicle.length;
  const auto conflict = PredictConflict(
      options_.vehicle, plan.reference, at.s, KnownObstacles(state, plan.reference.path, at.s),
      options.settings.safe_distance, options.settings.look_ahead, at.cross_track);
  return conflict && conflict->station - at.s < stop;
}

double ReplanningMonitor::HardestBraking(const Path& path, double station, double speed) const {
  constexpr double kSpacing = 1.0;          // [m]
  constexpr double kMinDeceleration = 0.1;  // [m/s^2]
  double hardest = MaxDeceleration(options_.vehicle, 1.0);
  // Low friction extends the searched distance, since the car then needs a longer distance to stop.
  for (double ahead = 0.0; hardest > kMinDeceleration && 2.0 * hardest * ahead <= speed * speed;
       ahead += kSpacing) {
    const PathPoint at = path.At(station + ahead);
    double road = std::numeric_limits<double>::infinity();
    for (const Vec2& corner : FootprintAt(options_.vehicle, at.pose).Corners()) {
      road = std::min(road, RoadFactor(options_.world, corner));
    }
    const double grip = MaxDeceleration(options_.vehicle, road);
    // In a bend, the lateral force reduces the braking force (friction ellipse). Assume that at
    // least about a third (sqrt 0.1) of the braking force remains, since a car that is too fast for
    // the bend slides anyway.
    const double across = (speed * speed - 2.0 * hardest * ahead) * std::abs(at.curvature);
    const double most = MaxLateralAcceleration(options_.vehicle, road);
    const double rest =
        most > 0.0 ? std::sqrt(std::max(0.1, 1.0 - std::pow(across / most, 2))) : 1.0;
    const Eigen::Vector3d normal = GroundNormal(options_.world, at.pose.position());
    const double downhill = normal.head<2>().dot(Direction(at.pose.yaw)) / normal.z();
    hardest = std::min(hardest, grip * rest - kGravity * std::max(0.0, downhill));
  }
  return options_.vehicle.max_deceleration > 0.0 ? std::max(hardest, kMinDeceleration) : 0.0;
}

double ReplanningMonitor::StationOnRoute(const VehicleState& state) const {
  constexpr double kSearch = 3.0;  // [m]
  const double station = driving_.route_station;
  const double moved = 2.0 * std::abs(state.speed) * options_.replanning.replan->period;
  return driving_.route.reference.path
      .Project(state.pose, {station - kSearch, station + kSearch + moved})
      .s;
}

ReplanRequest ReplanningMonitor::RequestFor(const VehicleState& state, const Plan& plan,
                                            const Projection& at) const {
  const VehicleParams& vehicle = options_.vehicle;
  const double speed = std::abs(state.speed);
  return {.vehicle = vehicle,
          .speed = options_.replanning.limits,
          .wind = options_.world.wind,
          .time = state.time,
          .car = {.pose = state.pose,
                  .curvature = CurvatureForSteering(vehicle, state.steering),
                  .speed = speed},
          .strayed = std::abs(at.cross_track) > kStrayed ||
                     std::abs(at.heading_error) > kStrayedHeading ||
                     std::abs(plan.reference.speed.SpeedAt(at.s) - speed) > kStrayedSpeed,
          .max_deceleration = HardestBraking(plan.reference.path, at.s, speed),
          .obstacles = KnownObstacles(state, plan.reference.path, at.s),
          .seed = options_.seed + static_cast<std::uint64_t>(periods_) * 1000,
          .road = Road()};
}

std::optional<FeasiblePlan> ReplanningMonitor::ReplanIfDue(const VehicleState& state,
                                                           const Plan& plan, const Projection& at) {
  const ReplanOptions& options = *options_.replanning.replan;
  const bool due = state.time >= static_cast<double>(periods_) * options.period - kSameTime;
  if (!due && !IsUrgent(state, plan, at)) {
    return std::nullopt;
  }
  driving_.route_station = StationOnRoute(state);
  driving_.plan = plan;
  driving_.station = at.s;
  const ReplanRequest request = RequestFor(state, plan, at);
  periods_ += due ? 1 : 0;
  Replanned next = Replan(request, driving_, options);
  constexpr double kNegligible = 0.1;  // [m]
  const bool moves =
      next.kind != ReplanKind::kKeep && next.plan->reference.path.length() > kNegligible;
  gave_up_ = std::abs(state.speed) < kAtRestSpeed && !moves &&
             !MightClear(options_.vehicle, driving_.route.reference.path, driving_.route_station,
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
