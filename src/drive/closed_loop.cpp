#include "trackbed/drive/closed_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "src/drive/fault_injector.h"
#include "src/drive/loop_preconditions.h"
#include "src/drive/recorder.h"
#include "src/drive/replanning_monitor.h"
#include "src/drive/scheduled_steering.h"
#include "src/drive/segment_sequencer.h"
#include "src/drive/slip_control.h"
#include "src/drive/standstill.h"
#include "src/drive/termination.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"

// Simulates a controller and a plant in a closed loop. Each control period has these steps:
//   1. Observe the plant. Switch to a replanned path or the next segment if one is due.
//   2. End the run if the termination criteria are met (termination.h).
//   3. Compute steering and acceleration from the controller, the speed options or the plan's speed
//      profile. Apply the disturbances and log the row.
//   4. Step the plant until the next period. Prescribed angles and steering schedules change at
//      every physics step; other commands are held constant.
namespace trackbed {
namespace {

/// Reports the progress of the run each time it has grown by one percent.
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

/// Simulates one run. The arguments of the constructor must outlive the ClosedLoop, which refers to
/// them.
class ClosedLoop {
 public:
  ClosedLoop(Plant& plant, SteeringController& controller, const FeasiblePlan& plan,
             const LoopConfig& config);

  RunLog Run();

 private:
  /// Returns the plant's state at the beginning of a control period.
  [[nodiscard]] VehicleState Observe(long tick) const;

  /// Switches to a new plan or to the next segment if one is due. Returns the car's projection onto
  /// the plan, or none without a path.
  std::optional<Projection> FollowPlan(const VehicleState& state, bool at_rest);

  /// Returns whether the car is at rest and will stay at rest. A car at standstill counts as at
  /// rest if it has no command to move. At the end of its segment, a car also counts as at rest if
  /// it cannot move despite a command, for example on a grade.
  bool Rests(const VehicleState& state);

  /// Returns the final status of the run if the run has ended.
  std::optional<DriveStatus> Ending(const VehicleState& state, bool at_rest);

  /// Computes the command for the coming period and stores the command in `row`. Returns the input
  /// with which the controller was called.
  ControlInput Control(const VehicleState& state, LogRow& row);
  double Steer(const ControlInput& input);
  /// Returns the commanded acceleration along the car's x axis [m/s^2] over the control period of
  /// `row`.
  double Accelerate(const ControlInput& input, const LogRow& row);
  /// Returns the wanted acceleration of the car, before disturbances. Options that prescribe the
  /// speed over time override the controller, and the controller overrides the plan's speed
  /// profile.
  double WantedAcceleration(const ControlInput& input, const Vec2& position);
  /// Returns the planned speed that is logged in LogRow::planned_speed.
  [[nodiscard]] std::optional<double> PlannedSpeed(const VehicleState& state) const;

  /// Steps the plant for the control period of `row`.
  void StepPlant(long tick, const ControlInput& input, const LogRow& row);
  [[nodiscard]] Command CommandAt(int step, const ControlInput& input, const LogRow& row);
  /// Returns the command of the steering schedule in a physics step. The steering schedule is a
  /// function of the driven distance.
  [[nodiscard]] Command ScheduledCommand(int step, const ControlInput& input, const LogRow& row);

  void ReportProgress(const VehicleState& state);

  Plant& plant_;
  SteeringController& controller_;
  const LoopConfig& config_;
  VehicleState start_;
  VehicleParams controlled_;  // Parameters of the nominal vehicle, which the controller assumes.
  int steps_;                 // Number of plant steps per control period.
  SegmentSequencer sequencer_;
  std::optional<ReplanningMonitor> monitor_;
  FaultInjector faults_;
  Recorder recorder_;
  Termination termination_;
  Standstill standstill_;
  Progress progress_;
  bool plan_sets_speed_ = false;
  Command command_;         // The last command.
  double steering_before_;  // Prescribed steering angle at the start of the period [rad].
  // Whether the loop has adopted, in this control period, a plan that does not stop at an obstacle.
  // After such a change of plan, the last command may still stop the car for the previous plan;
  // this stop must not end the run.
  bool continues_past_obstacle_ = false;
};

ClosedLoop::ClosedLoop(Plant& plant, SteeringController& controller, const FeasiblePlan& plan,
                       const LoopConfig& config)
    : plant_(plant),
      controller_(controller),
      config_(config),
      start_(plant.Observe()),
      controlled_(
          NominalVehicle(config.disturbances, config.nominal_vehicle.value_or(config.vehicle))),
      steps_(static_cast<int>(std::lround(config.control_period / config.timestep))),
      sequencer_(plan, start_,
                 {.station_source = config.station_source,
                  .vehicle = config.vehicle,
                  .control_period = config.control_period,
                  .goal_tolerance = config.goal_tolerance * config.vehicle.length}),
      faults_(config.disturbances, {.timestep = config.timestep,
                                    .start_steering = start_.steering_actuator,
                                    .speed = config.speed,
                                    .seed = config.seed}),
      recorder_(config, controller.Columns()),
      termination_(config, plan),
      progress_(config.hooks.progress),
      steering_before_(start_.steering_actuator / config.disturbances.steering.factor) {
  if (config.replanning) {
    monitor_.emplace(
        ReplanningMonitor::Options{.replanning = *config.replanning,
                                   .vehicle = config.nominal_vehicle.value_or(config.vehicle),
                                   .world = config.world,
                                   .seed = config.seed},
        plan);
  }
  command_.gear = sequencer_.has_path() ? PlanGear(sequencer_.plan()) : 1;
}

RunLog ClosedLoop::Run() {
  recorder_.Sample(plant_, 0.0);
  for (long tick = 0;; ++tick) {
    const VehicleState state = Observe(tick);
    LogRow row = recorder_.BeginRow(state, command_, controller_.Values());
    row.measured = faults_.Measure(state.pose);
    const bool at_rest = tick > 0 && Rests(state);
    row.tracking = FollowPlan(state, at_rest);
    if (const std::optional<DriveStatus> status = Ending(state, at_rest)) {
      if (*status != DriveStatus::kDiverged || tick == 0) {
        recorder_.AddRow(row);  // the final row repeats the last command
      }
      progress_.Report(1.0);
      return recorder_.Finish(*status, termination_.cause());
    }
    const ControlInput input = Control(state, row);
    recorder_.AddRow(row);
    StepPlant(tick, input, row);
    ReportProgress(state);
  }
}

VehicleState ClosedLoop::Observe(long tick) const {
  VehicleState state = plant_.Observe();
  // Rounds the time to nanoseconds, for example 11.700000000000001 to 11.7.
  state.time = std::round(static_cast<double>(tick) * config_.control_period * 1e9) / 1e9;
  return state;
}

std::optional<Projection> ClosedLoop::FollowPlan(const VehicleState& state, bool at_rest) {
  std::optional<Projection> tracking = sequencer_.Project(state);
  if (!tracking) {
    return std::nullopt;
  }
  continues_past_obstacle_ = false;
  // Do not replan after a collision, since the car no longer follows its plan.
  if (monitor_ && !recorder_.contact_time()) {
    const Projection at{sequencer_.station(), tracking->cross_track, tracking->heading_error};
    if (std::optional<FeasiblePlan> next = monitor_->Update(state, sequencer_.plan(), at)) {
      sequencer_.Replace(*next, state);
      recorder_.AddPlanChange({state.time, sequencer_.offset(), sequencer_.plan()});
      continues_past_obstacle_ = sequencer_.plan().blocked.empty();
      tracking = sequencer_.Project(state);
    }
  }
  if (at_rest && sequencer_.Advance(state)) {
    tracking = sequencer_.Project(state);
  }
  sequencer_.stationary_steer().Update(state.steering_actuator);
  if (!sequencer_.stationary_steer().InProgress()) {
    command_.gear = PlanGear(sequencer_.plan());
  }
  return tracking;
}

bool ClosedLoop::Rests(const VehicleState& state) {
  // Within this duration [s], a car that starts from rest with more than 0.02 m/s^2 moves farther
  // than 1 cm, the limit of Standstill.
  constexpr double kMinRestDuration = 1.0;  // Duration for which a car must rest [s].
  const bool steers = sequencer_.stationary_steer().InProgress();
  const std::optional<double> since = standstill_.Update(state, !steers);
  if (steers || IsAtRest(state, command_)) {
    return !steers;
  }
  return since && state.time - *since > kMinRestDuration && std::abs(state.speed) < kAtRestSpeed &&
         sequencer_.IsAtEnd(state);
}

std::optional<DriveStatus> ClosedLoop::Ending(const VehicleState& state, bool at_rest) {
  const bool steers = sequencer_.stationary_steer().InProgress();
  const bool waits = monitor_ && monitor_->IsWaiting();
  return termination_.Update(
      {.state = state,
       .plant = plant_,
       .segment = sequencer_.plan(),
       .is_last_segment = sequencer_.is_last(),
       .interrupted = config_.hooks.interrupted && config_.hooks.interrupted(),
       .at_rest = at_rest,
       .to_move = command_.acceleration * command_.gear > 0.0 && !steers && !at_rest,
       .run_continues = steers || waits || continues_past_obstacle_,
       .contact_time = recorder_.contact_time()});
}

ControlInput ClosedLoop::Control(const VehicleState& state, LogRow& row) {
  const Plan& plan = sequencer_.plan();
  ControlInput input{.vehicle = controlled_,
                     .reference = plan.reference,
                     .schedule = plan.schedule,
                     .state = state,
                     .station = sequencer_.StationFor(state),
                     .period = config_.control_period,
                     .plan_time = state.time - sequencer_.start_time(),
                     .speed_gain = config_.speed.gain};
  if (row.measured) {
    input.state.pose = *row.measured;
    if (sequencer_.has_path() && config_.station_source == StationSource::kProjection) {
      input.station = sequencer_.StationNear(*row.measured);
    }
  }
  command_.steering = Steer(input);
  command_.acceleration = Accelerate(input, row);
  TRACKBED_REQUIRE(std::isfinite(command_.steering) && std::isfinite(command_.acceleration),
                   "SimulateClosedLoop: at {} s the controller asks for a steering angle of {} rad "
                   "and an acceleration of {} m/s^2; must be finite",
                   state.time, command_.steering, command_.acceleration);
  command_.coast = Coasts(config_.speed, state.time);
  row.command = command_;
  row.controller = controller_.Values();
  row.planned_speed = PlannedSpeed(state);
  return input;
}

double ClosedLoop::Steer(const ControlInput& input) {
  if (!config_.hooks.steered) {
    return controller_.Steer(input);
  }
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const double steering = controller_.Steer(input);
  config_.hooks.steered(std::chrono::duration<double>(Clock::now() - start).count());
  return steering;
}

double ClosedLoop::Accelerate(const ControlInput& input, const LogRow& row) {
  const double station = row.tracking ? row.tracking->s : input.state.distance;
  const double left =
      faults_.LimitSpeed(WantedAcceleration(input, row.state.pose.position()),
                         command_.gear * input.state.speed, input.state.time, station);
  const bool steers = sequencer_.stationary_steer().InProgress();
  return command_.gear * (steers ? -config_.speed.deceleration : left);
}

double ClosedLoop::WantedAcceleration(const ControlInput& input, const Vec2& position) {
  // Speed of the car in the direction of the gear; negative if the car rolls in the opposite
  // direction.
  const double speed = command_.gear * input.state.speed;
  std::optional<double> own =
      TimedSpeedControl(config_.speed, input.state.time, speed, input.period);
  if (!own) {
    own = controller_.Accelerate(input);
  }
  plan_sets_speed_ = !own;
  if (own) {
    return *own;
  }
  const double hardest = MaxDeceleration(controlled_, RoadFactor(config_.world, position));
  const double wanted =
      SpeedControl(config_.speed, sequencer_.speed(), input.station, speed, input.period, hardest);
  const bool at_limit =
      sequencer_.has_path() && sequencer_.plan().diagnostics.speed_profile.has_value();
  return at_limit ? command_.gear * EaseForSlip(command_.gear * wanted, input.state) : wanted;
}

std::optional<double> ClosedLoop::PlannedSpeed(const VehicleState& state) const {
  if (!sequencer_.has_path() || !plan_sets_speed_) {
    return std::nullopt;
  }
  // The car may stop anywhere within the goal tolerance of the goal. Therefore the check of the
  // planned speeds also accepts a stop within the goal tolerance along the path.
  const double to = sequencer_.StationFor(state);
  const double from = to - config_.goal_tolerance * config_.vehicle.length -
                      std::abs(state.speed) * config_.control_period;
  const SpeedProfile& plan = sequencer_.speed();
  double highest = std::max(plan.SpeedAt(from), plan.SpeedAt(to));
  for (const SpeedProfile::Knot& knot : plan.knots()) {
    highest = knot.s > from && knot.s < to ? std::max(highest, knot.speed) : highest;
  }
  return highest;
}

void ClosedLoop::StepPlant(long tick, const ControlInput& input, const LogRow& row) {
  for (int step = 0; step < steps_ && !plant_.diverged(); ++step) {
    Command now = CommandAt(step, input, row);
    now.steering = faults_.Steer(now.steering);
    faults_.Kick(tick * steps_ + step, plant_);
    plant_.Step(now);
    if (!plant_.diverged()) {
      recorder_.Sample(plant_, row.state.time + (step + 1) * config_.timestep);
    }
  }
  steering_before_ = command_.steering;
}

Command ClosedLoop::CommandAt(int step, const ControlInput& input, const LogRow& row) {
  if (config_.follow_schedule) {
    return ScheduledCommand(step, input, row);
  }
  Command now = command_;
  if (config_.steering_input == SteeringInput::kPrescribed) {
    // The wheels reach the commanded angle at the end of the control period; in earlier physics
    // steps, the angle is interpolated.
    now.steering =
        std::lerp(steering_before_, command_.steering, static_cast<double>(step + 1) / steps_);
  }
  return now;
}

Command ClosedLoop::ScheduledCommand(int step, const ControlInput& input, const LogRow& row) {
  ControlInput at = input;
  at.period = config_.timestep;
  if (step > 0) {
    at.state = plant_.Observe();
    at.state.time = row.state.time + step * config_.timestep;
    at.station = sequencer_.StationFor(at.state);
  }
  Command now = command_;
  now.acceleration = Accelerate(at, row);
  const bool prescribed = config_.steering_input == SteeringInput::kPrescribed;
  now.steering =
      ScheduledSteering(sequencer_.plan().schedule,
                        {at.station, std::abs(at.state.speed), command_.gear * now.acceleration},
                        config_.timestep, prescribed ? 0.0 : controlled_.steering_rate);
  return now;
}

void ClosedLoop::ReportProgress(const VehicleState& state) {
  const double offset = sequencer_.offset();
  progress_.Report(sequencer_.has_path() ? (offset + sequencer_.StationFor(state)) /
                                               (offset + sequencer_.plan().reference.path.length())
                                         : state.time / termination_.end_time());
}

}  // namespace

RunLog SimulateClosedLoop(Plant& plant, SteeringController& controller, const FeasiblePlan& plan,
                          const LoopConfig& config) {
  CheckLoopArguments(plant, plan, config);
  return ClosedLoop(plant, controller, plan, config).Run();
}

}  // namespace trackbed
