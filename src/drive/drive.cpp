#include "trackbed/drive/drive.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>

#include "src/drive/collision_watch.h"
#include "src/drive/configuration_log.h"
#include "src/drive/disturber.h"
#include "src/drive/legs.h"
#include "src/drive/lookout.h"
#include "src/drive/path_tracking.h"
#include "src/drive/scheduled_steering.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/schedule.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

/// Slower than this, and not asked to move, counts as at rest [m/s].
constexpr double kAtRest = 0.01;
/// How long a collision is followed before the drive ends [s].
constexpr double kAfterCollision = 1.0;
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

/// Beyond any slope that a car stands on, and any lean that it comes back from.
bool HasRolledOver(const VehicleState& state) {
  constexpr double kUpright = 0.5;  // cosine of the angle from the vertical
  return std::cos(state.roll) * std::cos(state.pitch) < kUpright;
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

/// What is set over time goes first, then what the controller wants, then the plan's profile. A car
/// that rolls back has a negative speed along its gear.
double WantedAcceleration(const SpeedControlOptions& options, SteeringController& controller,
                          const ControlInput& input, int gear, const SpeedProfile& profile,
                          double max_deceleration) {
  const double speed = gear * input.state.speed;
  std::optional<double> own = TimedSpeedControl(options, input.state.time, speed, input.period);
  if (!own) {
    own = controller.Accelerate(input);
  }
  return own ? *own
             : SpeedControl(options, profile, input.station, speed, input.period, max_deceleration);
}

}  // namespace

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
  const bool by_schedule = scenario.control.steering.Is<ScheduleOptions>();

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
    if (HasRolledOver(state)) {
      log.rows.push_back(row);
      log.status = DriveStatus::kRolledOver;
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
    const auto accelerate = [&](const ControlInput& at) {
      const double hardest =
          MaxDeceleration(believed, RoadFactor(scenario.world, state.pose.position()));
      const double wanted = disturber.Slow(
          WantedAcceleration(scenario.control.speed, *controller, at, command.gear, speed, hardest),
          command.gear * at.state.speed, at.state.time,
          row.tracking ? row.tracking->s : at.state.distance);
      return command.gear * (stood ? -scenario.control.speed.deceleration : wanted);
    };
    command.acceleration = accelerate(input);
    command.coast = Coasts(scenario.control.speed, state.time);
    row.command = command;
    row.controller = controller->Values();
    log.rows.push_back(row);

    // Drive. Prescribed wheels reach the wanted angle at the end of the period, on a ramp. What a
    // schedule says is a function of the distance, and is followed at every step.
    for (int step = 0; step < steps_per_period && !plant->diverged(); ++step) {
      Command now = command;
      if (by_schedule) {
        ControlInput at = input;
        at.period = drive.timestep;
        if (step > 0) {
          at.state = plant->Observe();
          at.state.time = state.time + step * drive.timestep;
          at.station = at.state.distance - driven.distance;
        }
        now.acceleration = accelerate(at);
        now.steering = ScheduledSteering(
            driven.plan.schedule,
            {at.station, std::abs(at.state.speed), command.gear * now.acceleration}, drive.timestep,
            drive.steering == SteeringInput::kPrescribed ? 0.0 : believed.steering_rate);
      } else if (drive.steering == SteeringInput::kPrescribed) {
        now.steering =
            std::lerp(asked, command.steering, static_cast<double>(step + 1) / steps_per_period);
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
