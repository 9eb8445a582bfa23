#include "trackbed/recording/windows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "trackbed/control/playback.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/recording/relative_rms.h"
#include "trackbed/sim/plant.h"
#include "trackbed/vehicle/steering_actuator.h"
#include "trackbed/vehicle/steering_response.h"

namespace trackbed {
namespace {

/// Data that is common to all prediction windows of a replayed drive.
struct Replay {
  const CarModel& car;
  const RecordedDrive& drive;
  const ReplayOptions& options;
  PlaybackOptions inputs;
  int steps;  // number of simulation steps per control period
};

/// State of the simulated steering actuator at one time of the recorded drive.
struct SteeringHistory {
  SteeringFilter filter;
  double angle;  // [rad]
};

int StepsPerPeriod(double period, double timestep) {
  const double steps = period / timestep;
  TRACKBED_REQUIRE(
      steps > 0.5 && steps < 1e6 && std::abs(steps - std::round(steps)) < 1e-6,
      "PredictWindows: a control period of {} s is no whole number of timesteps of {} s", period,
      timestep);
  return static_cast<int>(std::lround(steps));
}

/// Simulates the steering actuator with the commands of the recorded drive, from the start of the
/// drive. Returns the actuator's state at the beginning of each control period in `periods`, which
/// must be in ascending order.
std::vector<SteeringHistory> FollowCommands(const Replay& replay,
                                            const std::vector<long>& periods) {
  const VehicleParams& params = replay.car.params();
  const double timestep = replay.car.timestep();
  const double period = replay.options.control_period;
  const SteeringLimits limits{params.steering_limit, params.steering_rate};
  const double start = RestingSteering(params, replay.inputs.recording.steering.At(0.0));
  SteeringHistory now{SteeringFilter(params.steering_response, timestep, start), start};
  std::vector<SteeringHistory> found;
  long done = 0;
  for (const long wanted : periods) {
    for (; done < wanted; ++done) {
      const double command =
          PlaybackSteering(replay.inputs, static_cast<double>(done) * period, 0.0, period);
      for (int i = 0; i < replay.steps; ++i) {
        const double target = now.filter.Pass(command);
        now.angle = MoveSteering(limits, now.angle, target).At(timestep);
      }
    }
    found.push_back(now);
  }
  return found;
}

Command CommandAt(const Replay& replay, double time, double speed) {
  const double period = replay.options.control_period;
  return {.steering = PlaybackSteering(replay.inputs, time, speed, period),
          .acceleration =
              PlaybackAcceleration(replay.inputs, time, speed, replay.options.speed_gain, period)
                  .value_or(0.0)};
}

VehicleState StateAt(const Plant& plant, double time) {
  VehicleState state = plant.Observe();
  state.time = time;
  return state;
}

WindowPrediction Predict(const Replay& replay, const std::string& name, long first, long count,
                         const SteeringHistory& steering) {
  const double period = replay.options.control_period;
  WindowPrediction window{.start = static_cast<double>(first) * period};
  const RecordedSample from = replay.drive.At(window.start);
  const bool prescribed = replay.options.input == SteeringInput::kPrescribed;
  const double angle =
      prescribed ? replay.inputs.recording.steering.At(window.start) : steering.angle;
  const auto plant = MakePlant(name, {.car = replay.car,
                                      .world = replay.options.world,
                                      .start = StartFrom(from, angle),
                                      .tyre = replay.options.tyre,
                                      .steering = replay.options.input,
                                      .aids = replay.options.aids,
                                      .filter = steering.filter});
  window.states.push_back(StateAt(*plant, window.start));
  for (long k = 0; k < count; ++k) {
    const double time = static_cast<double>(first + k) * period;
    const Command command = CommandAt(replay, time, window.states.back().speed);
    for (int i = 0; i < replay.steps && !plant->diverged(); ++i) {
      plant->Step(command);
    }
    if (plant->diverged()) {
      window.diverged = true;
      break;
    }
    window.states.push_back(StateAt(*plant, static_cast<double>(first + k + 1) * period));
  }
  return window;
}

/// Returns a quantile of a sorted list of values, with linear interpolation between the values.
double QuantileOf(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto before = static_cast<std::size_t>(place);
  const std::size_t after = std::min(before + 1, sorted.size() - 1);
  const double rest = place - static_cast<double>(before);
  return rest == 0.0                 ? sorted[before]
         : std::isinf(sorted[after]) ? sorted[after]
                                     : std::lerp(sorted[before], sorted[after], rest);
}

}  // namespace

std::vector<WindowPrediction> PredictWindows(const CarModel& car, const std::string& plant,
                                             const RecordedDrive& drive,
                                             const std::vector<double>& restarts, double horizon,
                                             const ReplayOptions& options) {
  const double period = options.control_period;
  const int steps = StepsPerPeriod(period, car.timestep());
  PlaybackOptions inputs;
  inputs.recording = ReplayInputs(drive, options.steering, options.drive);
  const Replay replay{
      .car = car, .drive = drive, .options = options, .inputs = std::move(inputs), .steps = steps};
  const long count = std::lround(horizon / period);
  TRACKBED_REQUIRE(horizon > 0.0 && count >= 1,
                   "PredictWindows: a horizon of {} s; must be above 0", horizon);
  std::vector<long> first;
  for (const double restart : restarts) {
    // Allow 1.5 control periods more than the duration of the drive, because the drive may end
    // between two control periods.
    TRACKBED_REQUIRE(restart >= 0.0 && restart + horizon <= drive.duration() + 1.5 * period,
                     "PredictWindows: a window from {} s to {} s of a drive of {} s", restart,
                     restart + horizon, drive.duration());
    first.push_back(std::lround(restart / period));
  }
  std::vector<long> sorted = first;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  const std::vector<SteeringHistory> histories = FollowCommands(replay, sorted);
  std::vector<WindowPrediction> windows;
  windows.reserve(first.size());
  for (const long start : first) {
    if (options.interrupted && options.interrupted()) {
      break;
    }
    const auto at = std::lower_bound(sorted.begin(), sorted.end(), start) - sorted.begin();
    windows.push_back(
        Predict(replay, plant, start, count, histories[static_cast<std::size_t>(at)]));
  }
  return windows;
}

std::vector<double> WindowStarts(const RecordedDrive& drive, double horizon, double spacing,
                                 double min_speed) {
  TRACKBED_REQUIRE(horizon > 0.0 && spacing > 0.0,
                   "WindowStarts: horizon {} s, spacing {} s; must be above 0", horizon, spacing);
  const auto samples = static_cast<std::size_t>(std::lround(horizon / drive.period));
  std::vector<double> starts;
  for (std::size_t k = 0;; ++k) {
    const double start = static_cast<double>(k) * spacing;
    const auto first = static_cast<std::size_t>(std::lround(start / drive.period));
    if (first + samples >= drive.samples.size()) {
      return starts;
    }
    bool valid = true;
    double speed = 0.0;
    for (std::size_t i = first; i <= first + samples; ++i) {
      valid = valid && drive.samples[i].valid;
      speed += std::abs(drive.samples[i].velocity_V.x());
    }
    if (valid && speed >= min_speed * static_cast<double>(samples + 1)) {
      starts.push_back(start);
    }
  }
}

WindowErrors MeasureWindows(const std::vector<WindowPrediction>& windows,
                            const RecordedDrive& drive, const VehicleParams& vehicle,
                            double horizon, double min_speed) {
  TRACKBED_REQUIRE(!windows.empty(), "MeasureWindows: no windows");
  WindowErrors errors{.horizon = horizon, .count = static_cast<int>(windows.size())};
  std::vector<double> position;
  std::vector<double> heading;
  RelativeRms yaw_rate;
  RelativeRms lateral;
  for (const WindowPrediction& window : windows) {
    // Skip the first predicted state of a window, because it is equal to the recorded state.
    for (std::size_t k = 1; k < window.states.size(); ++k) {
      const VehicleState& state = window.states[k];
      const VehicleState recorded = StateOf(drive.At(state.time), vehicle, false);
      if (std::abs(recorded.speed) >= min_speed) {
        yaw_rate.Add(state.yaw_rate, recorded.yaw_rate);
        lateral.Add(state.lateral_acceleration, recorded.lateral_acceleration);
      }
    }
    const VehicleState& end = window.states.back();
    const Pose2 recorded = drive.At(end.time).pose;
    const double far = std::numeric_limits<double>::infinity();
    errors.diverged += window.diverged ? 1 : 0;
    position.push_back(window.diverged ? far : (end.pose.position() - recorded.position()).norm());
    heading.push_back(window.diverged ? far
                                      : std::abs(AngleDifference(end.pose.yaw, recorded.yaw)));
  }
  std::sort(position.begin(), position.end());
  std::sort(heading.begin(), heading.end());
  errors.position_median = QuantileOf(position, 0.5);
  errors.position_p90 = QuantileOf(position, 0.9);
  errors.heading_median = QuantileOf(heading, 0.5);
  errors.heading_p90 = QuantileOf(heading, 0.9);
  errors.yaw_rate_relative_rms = yaw_rate.value();
  errors.lateral_acceleration_relative_rms = lateral.value();
  return errors;
}

}  // namespace trackbed
