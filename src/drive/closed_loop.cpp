#include "trackbed/drive/closed_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "src/drive/loop_core.h"
#include "src/drive/loop_preconditions.h"
#include "src/drive/scheduled_steering.h"
#include "src/drive/slip_control.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"

// Simulates a controller and a plant in a closed loop. Each control period has these steps:
//   1. Observe the plant. Switch to a replanned path or the next segment if one is due.
//   2. End the run if the termination criteria are met (termination.h).
//   3. Compute steering and acceleration from the controller, the speed options or the plan's speed
//      profile. Apply the disturbances and log the row.
//   4. Step the plant until the next period. Prescribed steering angles and steering schedules
//      change at every physics step; other commands are constant within a control period.
namespace trackbed {

LoopCore::LoopCore(Plant& plant, const SteeringController& controller, const FeasiblePlan& plan,
                   const LoopConfig& config, bool keeps_rows)
    : plant_(&plant),
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
      surroundings_(config.world, config.vehicle),
      faults_(config.disturbances, {.timestep = config.timestep,
                                    .start_steering = start_.steering_actuator,
                                    .speed = config.speed,
                                    .seed = config.seed}),
      recorder_(config, controller.Columns(), keeps_rows),
      termination_(config, plan),
      progress_(config.hooks.progress),
      steering_before_(start_.steering_actuator / config.disturbances.steering.factor),
      values_(controller.Values()) {
  if (config.steering_input == SteeringInput::kPrescribed) {
    controlled_.steering_response = {};  // prescribed angles bypass the actuator
  }
  if (config.replanning) {
    monitor_.emplace(
        ReplanningMonitor::Options{.replanning = *config.replanning,
                                   .vehicle = config.nominal_vehicle.value_or(config.vehicle),
                                   .world = config.world,
                                   .seed = config.seed},
        plan);
  }
  command_.gear = sequencer_.has_path() ? PlanGear(sequencer_.plan()) : 1;
  recorder_.Sample(plant, 0.0);
  BeginPeriod();
}

void LoopCore::BeginPeriod() {
  state_ = Observe();
  row_ = recorder_.BeginRow(state_, command_, values_);
  row_.aids = plant_->aids();
  row_.trailer = plant_->trailer();
  row_.measured = faults_.Measure(state_.pose);
  const bool at_rest = tick_ > 0 && Rests(state_);
  row_.tracking = FollowPlan(state_, at_rest);
  surroundings_.BeginPeriod(state_, sequencer_.plan());
  status_ = Ending(state_, at_rest);
  if (!status_) {
    return;
  }
  if (*status_ != DriveStatus::kDiverged || tick_ == 0) {
    recorder_.AddRow(row_);  // the final row repeats the last command
  }
  progress_.Report(1.0);
}

void LoopCore::Step(SteeringController& controller, bool follow_schedule) {
  const ControlInput input = Input();
  Control(controller, input);
  recorder_.AddRow(row_);
  if (follow_schedule && config_.follow_schedule) {
    StepPlant([&](int step) { return ScheduledCommand(step, controller, input); });
  } else {
    StepPlant([&](int step) { return CommandAt(step); });
  }
  ReportProgress(state_);
  ++tick_;
  BeginPeriod();
}

VehicleState LoopCore::Observe() const {
  VehicleState state = plant_->Observe();
  // Rounds the time to nanoseconds, for example 11.700000000000001 to 11.7.
  state.time = std::round(static_cast<double>(tick_) * config_.control_period * 1e9) / 1e9;
  return state;
}

std::optional<Projection> LoopCore::FollowPlan(const VehicleState& state, bool at_rest) {
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
      surroundings_.ForgetPath();
      recorder_.AddPlanChange({state.time, sequencer_.offset(), sequencer_.plan()});
      continues_past_obstacle_ = sequencer_.plan().blocked.empty();
      tracking = sequencer_.Project(state);
    }
  }
  if (at_rest && sequencer_.Advance(state)) {
    surroundings_.ForgetPath();
    tracking = sequencer_.Project(state);
  }
  sequencer_.stationary_steer().Update(state.steering_actuator, state.time);
  if (!sequencer_.stationary_steer().InProgress()) {
    command_.gear = PlanGear(sequencer_.plan());
  }
  return tracking;
}

bool LoopCore::Rests(const VehicleState& state) {
  // A car that starts from rest with more than 0.02 m/s^2 moves by more than 1 cm within
  // kMinRestDuration, so the class Standstill detects its motion.
  constexpr double kMinRestDuration = 1.0;  // Duration for which a car must rest [s].
  const bool steers = sequencer_.stationary_steer().InProgress();
  const std::optional<double> since = standstill_.Update(state, !steers);
  if (steers || IsAtRest(state, command_)) {
    return !steers;
  }
  return since && state.time - *since > kMinRestDuration && std::abs(state.speed) < kAtRestSpeed &&
         sequencer_.IsAtEnd(state);
}

std::optional<DriveStatus> LoopCore::Ending(const VehicleState& state, bool at_rest) {
  const bool steers = sequencer_.stationary_steer().InProgress();
  const bool waits = monitor_ && monitor_->IsWaiting();
  return termination_.Update(
      {.state = state,
       .plant = *plant_,
       .segment = sequencer_.plan(),
       .is_last_segment = sequencer_.is_last(),
       .interrupted = config_.hooks.interrupted && config_.hooks.interrupted(),
       .at_rest = at_rest,
       .coasts = command_.coast,
       .to_move = command_.acceleration * command_.gear > 0.0 && !steers && !at_rest,
       .run_continues = steers || waits || continues_past_obstacle_,
       .contact_time = recorder_.contact_time()});
}

ControlInput LoopCore::Input() const {
  const Plan& plan = sequencer_.plan();
  ControlInput input{.vehicle = controlled_,
                     .reference = plan.reference,
                     .schedule = plan.schedule,
                     .state = state_,
                     .station = sequencer_.StationFor(state_),
                     .period = config_.control_period,
                     .plan_time = std::max(0.0, state_.time - sequencer_.start_time()),
                     .speed_gain = config_.speed.gain};
  if (row_.measured) {
    input.state.pose = *row_.measured;
    if (sequencer_.has_path() && config_.station_source == StationSource::kProjection) {
      input.station = sequencer_.StationNear(*row_.measured);
    }
  }
  return input;
}

bool LoopCore::CarCoasts() const {
  return BrakingHasBegun(config_.speed, state_.time) ? Coasts(config_.speed, state_.time)
                                                     : throttle_released_;
}

void LoopCore::Control(SteeringController& controller, const ControlInput& input) {
  throttle_released_ = throttle_released_ || (config_.coasts_from && row_.tracking &&
                                              row_.tracking->s >= *config_.coasts_from);
  if (auto* const sees = dynamic_cast<SeesSurroundings*>(&controller)) {
    sees->See(surroundings_);
  }
  command_.steering = Steer(controller, input);
  command_.acceleration = Accelerate(controller, input);
  TRACKBED_REQUIRE(std::isfinite(command_.steering) && std::isfinite(command_.acceleration),
                   "SimulateClosedLoop: at {} s the controller asks for a steering angle of {} rad "
                   "and an acceleration of {} m/s^2; must be finite",
                   state_.time, command_.steering, command_.acceleration);
  command_.coast = CarCoasts();
  values_ = controller.Values();
  row_.command = command_;
  row_.controller = values_;
  row_.planned_speed = PlannedSpeed(state_);
}

double LoopCore::Steer(SteeringController& controller, const ControlInput& input) {
  if (!config_.hooks.steered) {
    return controller.Steer(input);
  }
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const double steering = controller.Steer(input);
  config_.hooks.steered(std::chrono::duration<double>(Clock::now() - start).count());
  return steering;
}

double LoopCore::Accelerate(SteeringController& controller, const ControlInput& input) {
  const double station = row_.tracking ? row_.tracking->s : input.state.distance;
  const double left =
      faults_.LimitSpeed(WantedAcceleration(controller, input), command_.gear * input.state.speed,
                         input.state.time, station);
  const bool steers = sequencer_.stationary_steer().InProgress();
  return command_.gear * (steers ? -config_.speed.deceleration : left);
}

double LoopCore::WantedAcceleration(SteeringController& controller, const ControlInput& input) {
  // Speed of the car in the direction of the gear; negative if the car rolls against the gear.
  const double speed = command_.gear * input.state.speed;
  std::optional<double> own =
      TimedSpeedControl(config_.speed, input.state.time, speed, input.period);
  if (throttle_released_ && CarCoasts()) {
    own = 0.0;
  }
  if (!own) {
    own = controller.Accelerate(input);
  }
  plan_sets_speed_ = !own;
  if (own) {
    return *own;
  }
  const bool at_limit =
      sequencer_.has_path() && sequencer_.plan().diagnostics.speed_profile.has_value();
  const SpeedProfile& plan = sequencer_.speed();
  double hardest =
      MaxDeceleration(controlled_, RoadFactor(config_.world, row_.state.pose.position()));
  if (at_limit && hardest > 0.0) {
    // A speed profile at the car's limit brakes with tyres and drag, so at high speed it
    // decelerates more than the tyres alone can. The planned deceleration is within the grip of the
    // road, so allow it.
    hardest = std::max(hardest, -plan.AccelerationAt(input.station));
  }
  const double wanted =
      SpeedControl(config_.speed, plan, input.station, speed, input.period, hardest);
  return at_limit ? command_.gear * EaseForSlip(command_.gear * wanted, input.state) : wanted;
}

std::optional<double> LoopCore::PlannedSpeed(const VehicleState& state) const {
  if (!sequencer_.has_path() || !plan_sets_speed_) {
    return std::nullopt;
  }
  // Use the highest planned speed over the goal tolerance behind the car, because a car may stop
  // anywhere within the goal tolerance of the goal.
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

template <typename CommandOf>
void LoopCore::StepPlant(const CommandOf& command) {
  for (int step = 0; step < steps_ && !plant_->diverged(); ++step) {
    Command now = command(step);
    now.steering = faults_.Steer(now.steering);
    faults_.Kick(tick_ * steps_ + step, *plant_);
    plant_->Step(now);
    if (!plant_->diverged()) {
      recorder_.Sample(*plant_, row_.state.time + (step + 1) * config_.timestep);
    }
  }
  steering_before_ = command_.steering;
}

Command LoopCore::CommandAt(int step) const {
  Command now = command_;
  if (config_.steering_input == SteeringInput::kPrescribed) {
    // The prescribed wheel angle is interpolated over the physics steps, so that the wheels reach
    // the commanded angle at the end of the control period.
    now.steering =
        std::lerp(steering_before_, command_.steering, static_cast<double>(step + 1) / steps_);
  }
  return now;
}

Command LoopCore::ScheduledCommand(int step, SteeringController& controller,
                                   const ControlInput& input) {
  ControlInput at = input;
  at.period = config_.timestep;
  if (step > 0) {
    at.state = plant_->Observe();
    at.state.time = row_.state.time + step * config_.timestep;
    at.station = sequencer_.StationFor(at.state);
  }
  Command now = command_;
  now.acceleration = Accelerate(controller, at);
  const bool prescribed = config_.steering_input == SteeringInput::kPrescribed;
  now.steering =
      ScheduledSteering(sequencer_.plan().schedule,
                        {at.station, std::abs(at.state.speed), command_.gear * now.acceleration},
                        config_.timestep, prescribed ? 0.0 : controlled_.steering_rate);
  return now;
}

void LoopCore::ReportProgress(const VehicleState& state) {
  const double offset = sequencer_.offset();
  progress_.Report(sequencer_.has_path() ? (offset + sequencer_.StationFor(state)) /
                                               (offset + sequencer_.plan().reference.path.length())
                                         : state.time / termination_.end_time());
}

RunLog SimulateClosedLoop(Plant& plant, SteeringController& controller, const FeasiblePlan& plan,
                          const LoopConfig& config) {
  CheckLoopArguments(plant, plan, config);
  LoopCore loop(plant, controller, plan, config);
  while (!loop.status()) {
    loop.Step(controller, true);
  }
  return loop.TakeLog();
}

}  // namespace trackbed
