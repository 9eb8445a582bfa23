#include "trackbed/drive/drive.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>

#include "src/drive/collision_watch.h"
#include "src/drive/disturber.h"
#include "src/drive/legs.h"
#include "src/drive/lookout.h"
#include "src/drive/path_tracking.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/avoidance.h"

namespace trackbed {
namespace {

/// Slower than this, and not asked to move, counts as at rest [m/s].
constexpr double kAtRest = 0.01;
/// How long a collision is followed before the drive ends [s].
constexpr double kAfterCollision = 1.0;
/// Logs configurations at the first physics step at or after every multiple of the period.
class ConfigurationLog {
 public:
  ConfigurationLog(const CarModel& car, const World& world, double period)
      : period_(period), table_(Columns(car)) {
    for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
      const Obstacle& obstacle = world.obstacles[i];
      if (obstacle.moves()) {
        moving_.emplace_back(Find(fmt::format("obstacle_{}_x_m", i)), obstacle.velocity.x());
        moving_.emplace_back(Find(fmt::format("obstacle_{}_y_m", i)), obstacle.velocity.y());
      }
    }
  }

  void Record(const Plant& plant, double time) {
    // Half a microsecond: times are sums of timesteps and may fall short of the multiple by
    // rounding.
    if (time + 5e-7 < period_ * static_cast<double>(next_)) {
      return;
    }
    std::vector<double> row{time};
    const std::vector<double> configuration = plant.Configuration();
    row.insert(row.end(), configuration.begin(), configuration.end());
    for (const auto& [column, speed] : moving_) {
      row[column] = speed * time;  // whatever the plant knows of it
    }
    table_.AddRow(row);
    next_ = static_cast<long>(std::floor((time + 5e-7) / period_)) + 1;
  }

  Table Take() { return std::move(table_); }

 private:
  static std::vector<std::string> Columns(const CarModel& car) {
    std::vector<std::string> columns{"t_s"};
    const std::vector<std::string> configuration = car.configuration_columns();
    columns.insert(columns.end(), configuration.begin(), configuration.end());
    return columns;
  }

  [[nodiscard]] std::size_t Find(const std::string& column) const {
    const auto& columns = table_.columns();
    const auto found = std::find(columns.begin(), columns.end(), column);
    TRACKBED_CHECK(found != columns.end(), "configurations have no column '{}'", column);
    return static_cast<std::size_t>(found - columns.begin());
  }

  double period_;
  long next_ = 0;
  Table table_;
  std::vector<std::pair<std::size_t, double>> moving_;  // column and speed [m/s] of obstacles
};

/// Calls back when another hundredth is done.
class Progress {
 public:
  explicit Progress(const std::function<void(double)>& callback) : callback_(callback) {}

  void Report(double fraction) {
    const int hundredths = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * 100.0);
    if (callback_ && hundredths > last_) {
      last_ = hundredths;
      callback_(hundredths / 100.0);
    }
  }

 private:
  const std::function<void(double)>& callback_;
  int last_ = 0;
};

/// The plan that is driven, and where it began.
struct Driven {
  Plan plan;
  double station = 0.0;   ///< in the log, where the plan's own stations begin [m]
  double distance = 0.0;  ///< odometer there [m]
  double time = 0.0;      ///< then [s]
};

/// Whether a car that stands at `pose` has reached `goal`.
bool IsAtGoal(const Scenario& scenario, double tolerance, const Pose2& pose, const Pose2& goal) {
  const bool has_heading = !scenario.mission.headings.empty();
  return (pose.position() - goal.position()).norm() <= tolerance &&
         (!has_heading ||
          std::abs(AngleDifference(pose.yaw, goal.yaw)) <= scenario.drive.goal_heading_tolerance);
}

bool AtRest(const VehicleState& state, const Command& command) {
  return std::abs(state.speed) < kAtRest && command.acceleration * command.gear <= 0.0;
}

/// Asks the controller, and tells how long it took.
double Steer(SteeringController& controller, const ControlInput& input, const DriveHooks& hooks) {
  if (!hooks.steered) {
    return controller.Steer(input);
  }
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const double steering = controller.Steer(input);
  hooks.steered(std::chrono::duration<double>(Clock::now() - start).count());
  return steering;
}

/// What is set over time goes first, then what the controller wants, then the plan's profile.
double WantedAcceleration(const SpeedControlOptions& options, SteeringController& controller,
                          const ControlInput& input, const SpeedProfile& profile,
                          double max_deceleration) {
  const double speed = std::abs(input.state.speed);
  std::optional<double> own = TimedSpeedControl(options, input.state.time, speed, input.period);
  if (!own) {
    own = controller.Accelerate(input);
  }
  return own ? *own
             : SpeedControl(options, profile, input.station, speed, input.period, max_deceleration);
}

}  // namespace

CarModel LoadCar(const Scenario& scenario) {
  const auto file = FindModel(scenario.vehicle.model, scenario.folder);
  CarModel car(ComposeScene(file, {.timestep = scenario.drive.timestep,
                                   .steering_rate = scenario.vehicle.steering_rate}),
               file.string());
  if (scenario.disturb.payload) {
    car = {WithPayload(car, *scenario.disturb.payload), file.string()};
  }
  if (scenario.world.obstacles.empty() && IsFlat(scenario.world.ground)) {
    return car;
  }
  return {WithWorld(car.scene(), car.params(), scenario.world), file.string()};
}

Plan PlanMission(const Scenario& scenario, const VehicleParams& vehicle) {
  const StartState start = StartOf(scenario);
  if (!scenario.plan) {
    Plan plan;
    plan.reference.speed = SpeedProfile({{0.0, SpeedOf(scenario)}});
    plan.schedule_speed = plan.reference.speed;
    return plan;
  }
  std::vector<OrientedBox> known;
  for (const Obstacle& obstacle : scenario.world.obstacles) {
    // What moves will be elsewhere: whoever plans again on the way reckons with that.
    const bool for_later = obstacle.moves() && scenario.plan->replan;
    if (!for_later && IsKnown(obstacle, 0.0, OutlineAt(vehicle, start.pose))) {
      known.push_back(obstacle.footprint);
    }
  }
  const auto begin = std::chrono::steady_clock::now();
  const PlanRequest request{
      .vehicle = vehicle,
      .waypoints = scenario.mission.waypoints,
      .headings = scenario.mission.headings,
      .obstacles = known,
      .wind = scenario.world.wind,
      .start = start.pose,
      .start_speed = start.speed,
      .start_steering = start.steering,
      .speed = SpeedLimitsOf(scenario),
      .seed = scenario.seed,
      .clock =
          [begin] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
          },
      .friction = scenario.world.friction,
      .friction_patches = scenario.world.friction_patches,
      .infeasible = scenario.plan->infeasible};
  Plan plan = MakePlan(request, scenario.plan->global);
  if (!plan.ok() || !scenario.plan->avoid) {
    return plan;
  }
  std::erase_if(known, [&](const OrientedBox& box) {
    return !IsForAvoider(*scenario.plan, vehicle, plan.reference.path, 0.0, box);
  });
  return PlanAround({.vehicle = vehicle,
                     .plan = plan,
                     .speed = SpeedLimitsOf(scenario),
                     .obstacles = known,
                     .station = 0.0,
                     .station_speed = start.speed,
                     .car = {},
                     .seed = scenario.seed},
                    *scenario.plan->avoid);
}

RunLog DrivePlant(const Scenario& scenario, const CarModel& car, const Plan& plan,
                  const std::string& plant_name, const DriveHooks& hooks) {
  TRACKBED_CHECK(plan.ok(), "a plan with status {} cannot be driven", ToString(plan.status));
  const DriveSpec& drive = scenario.drive;
  const bool has_path = scenario.plan.has_value();
  const std::optional<double> duration = DurationOf(scenario);
  double end_time = std::min(drive.time_limit, duration.value_or(drive.time_limit));
  const auto steps_per_period =
      static_cast<int>(std::lround(drive.control_period / drive.timestep));
  const StationSource source = ControllerFor(scenario.control.steering).station;
  const double arrival = drive.goal_tolerance * car.params().length;  // [m]
  const bool by_schedule = std::holds_alternative<ScheduleOptions>(scenario.control.steering);

  const VehicleParams believed = BelievedBy(scenario.disturb, car);
  const auto controller = MakeSteeringController(scenario.control.steering);
  const auto plant = MakePlant(plant_name, {.car = car,
                                            .world = scenario.world,
                                            .start = StartOf(scenario),
                                            .tyre = scenario.vehicle.tyre,
                                            .steering = drive.steering});
  RunLog log{.plant = plant_name,
             .status = DriveStatus::kArrived,
             .controller_columns = controller->Columns(),
             .rows = {},
             .changes = {},
             .configurations = Table({"t_s"})};
  ConfigurationLog configurations(car, scenario.world, drive.state_period);
  configurations.Record(*plant, 0.0);
  Progress progress(hooks.progress);

  std::deque<Plan> legs = InLegs(plan);
  Driven driven{legs.front()};
  legs.pop_front();
  Standing standing;
  bool stood = false;  // the last command was to stand until the wheels have turned
  if (has_path && StartOf(scenario).speed == 0.0 &&
      driven.plan.reference.path.At(0.0).curvature != 0.0) {
    standing.Begin();
  }
  Lookout lookout(scenario, car.unladen(), plan);
  Disturber disturber(scenario);
  CollisionWatch collisions(scenario.world, car.params());
  collisions.Update(*plant, 0.0);
  double station = 0.0;  // of the last projection, on the plan that is driven
  Command command;
  command.gear = has_path ? GearOf(driven.plan) : 1;
  double asked = StartOf(scenario).steering / scenario.disturb.steering.factor;  // last [rad]
  for (long tick = 0;; ++tick) {
    // Observe and project.
    VehicleState state = plant->Observe();
    // To the nanosecond: 11.7, not 11.700000000000001.
    state.time = std::round(static_cast<double>(tick) * drive.control_period * 1e9) / 1e9;
    LogRow row{.state = state,
               .command = command,
               .tracking = {},
               .clearance = {},
               .measured = disturber.Measure(state.pose),
               .controller = controller->Values()};
    const auto project = [&] {
      const Path& path = driven.plan.reference.path;
      const double moved = std::abs(state.speed) * drive.control_period;
      const Projection extended =
          path.Project(state.pose, StationsAround(car.params(), station, moved));
      station = extended.s;
      row.tracking = DistanceFromPath(path, extended, state.pose, legs.empty() ? arrival : 0.0);
      row.tracking->s += driven.station;
    };
    const bool at_rest = tick > 0 && !stood && AtRest(state, command);
    const bool by_odometer = source == StationSource::kOdometer;
    if (has_path) {
      project();
      const Projection at{station, row.tracking->cross_track, row.tracking->heading_error};
      if (std::optional<Plan> next = lookout.Look(state, driven.plan, at)) {
        driven = {std::move(*next), driven.station + station, state.distance, state.time};
        log.changes.push_back({state.time, driven.station, driven.plan});
        station = 0.0;
        legs.clear();
        project();
      }
      const double length = driven.plan.reference.path.length();
      const double covered = by_odometer ? state.distance - driven.distance : station;
      if (!legs.empty() && at_rest && covered >= length - std::min(arrival, 0.5 * length)) {
        driven = {std::move(legs.front()), driven.station + length, state.distance, state.time};
        legs.pop_front();
        station = 0.0;
        standing.Begin();
        project();
      }
    }
    stood = standing.GoesOn(state.steering_actuator);
    if (has_path && !stood) {
      command.gear = GearOf(driven.plan);
    }
    const Path& path = driven.plan.reference.path;
    const SpeedProfile& speed =
        by_odometer ? driven.plan.schedule_speed : driven.plan.reference.speed;
    const double s = by_odometer ? state.distance - driven.distance : station;

    const CollisionWatch::Period seen = collisions.Take();
    row.clearance = seen.clearance;
    row.state.obstacle_force = seen.force;
    log.contact_time = collisions.contact_time();
    if (log.contact_time) {
      end_time = std::min(end_time, *log.contact_time + kAfterCollision);
    }

    // Is it over? The last row keeps the command that led here.
    if (plant->diverged()) {
      log.status = DriveStatus::kDiverged;
      break;
    }
    const bool time_over = state.time >= end_time - 0.5 * drive.timestep;
    const bool interrupted = hooks.interrupted && hooks.interrupted();
    const bool stays = at_rest && !stood && !lookout.Waits();
    if (interrupted || time_over || (has_path && stays)) {
      log.rows.push_back(row);
      const bool there = has_path ? at_rest && legs.empty() &&
                                        IsAtGoal(scenario, arrival, state.pose, driven.plan.goal)
                                  : end_time == duration;
      const Vec2 end = path.At(path.length()).pose.position();
      const bool is_partial =
          at_rest && !plan.partial.empty() && (state.pose.position() - end).norm() <= arrival;
      log.status = interrupted                               ? DriveStatus::kInterrupted
                   : log.contact_time                        ? DriveStatus::kCollided
                   : at_rest && !driven.plan.blocked.empty() ? DriveStatus::kBlocked
                   : is_partial                              ? DriveStatus::kPartial
                   : there                                   ? DriveStatus::kArrived
                   : at_rest                                 ? DriveStatus::kStopped
                                                             : DriveStatus::kTimeLimit;
      break;
    }

    // Control and log.
    ControlInput input{.vehicle = believed,
                       .reference = driven.plan.reference,
                       .schedule = driven.plan.schedule,
                       .state = state,
                       .station = s,
                       .period = drive.control_period,
                       .plan_time = state.time - driven.time,
                       .speed_gain = scenario.control.speed.gain};
    if (row.measured) {
      input.state.pose = *row.measured;
      if (has_path && !by_odometer) {
        input.station = path.Project(*row.measured, StationsAround(car.params(), station, 0.0)).s;
      }
    }
    command.steering = Steer(*controller, input, hooks);
    const double hardest =
        MaxDeceleration(believed, RoadFactor(scenario.world, state.pose.position()));
    const double wanted = disturber.Slow(
        WantedAcceleration(scenario.control.speed, *controller, input, speed, hardest), state,
        row.tracking ? row.tracking->s : state.distance);
    command.acceleration = command.gear * (stood ? -scenario.control.speed.deceleration : wanted);
    row.command = command;
    row.controller = controller->Values();
    log.rows.push_back(row);

    // Drive. Prescribed wheels reach the wanted angle at the end of the period, on a ramp; those of
    // a schedule are where it says at every step, since it is a function of the distance.
    for (int step = 0; step < steps_per_period && !plant->diverged(); ++step) {
      Command now = command;
      if (drive.steering == SteeringInput::kPrescribed) {
        now.steering =
            std::lerp(asked, command.steering, static_cast<double>(step + 1) / steps_per_period);
      } else if (by_schedule) {
        const auto scheduled = [&](double time) {
          return driven.plan.schedule.At(s + time * std::abs(state.speed) +
                                         0.5 * time * time * command.gear * command.acceleration);
        };
        // An actuator turns at its full rate, then waits for the next step: on a slower ramp it is
        // early, on average by half the time it waits. Before a ramp of full rate nothing is left
        // to be made up.
        const double end = (step + 1) * drive.timestep;
        const auto wait = [&](double from) {
          const double turned = std::abs(scheduled(from + drive.timestep) - scheduled(from));
          return std::max(0.0, drive.timestep - turned / believed.steering_rate);
        };
        const double waits = std::min(wait(end - drive.timestep), wait(end));
        now.steering = scheduled(end - 0.5 * waits);
      }
      now.steering = disturber.Steer(now.steering);
      disturber.Kick(tick * steps_per_period + step, *plant);
      plant->Step(now);
      if (!plant->diverged()) {
        const double now_time = state.time + (step + 1) * drive.timestep;
        configurations.Record(*plant, now_time);
        collisions.Update(*plant, now_time);
      }
    }
    asked = command.steering;
    progress.Report(has_path ? (driven.station + s) / (driven.station + path.length())
                             : state.time / end_time);
  }
  progress.Report(1.0);
  log.configurations = configurations.Take();
  return log;
}

}  // namespace trackbed
