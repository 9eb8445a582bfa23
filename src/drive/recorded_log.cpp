#include "src/drive/recorded_log.h"

#include <algorithm>
#include <cmath>

#include "src/drive/configuration_log.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/plant.h"

namespace trackbed {
namespace {

/// Presents a recorded drive as a plant, so that ConfigurationLog can log the recorded car's
/// configurations.
class RecordedCar final : public Plant {
 public:
  RecordedCar(const CarModel& model, const RecordedDrive& drive) : model_(model), drive_(drive) {
    MoveTo(0.0);
  }

  void MoveTo(double time) {
    const VehicleState before = state_;
    const RecordedSample sample = drive_.At(time);
    state_ = StateOf(sample, model_.params(), drive_.has_steering);
    state_.time = time;
    if (!drive_.has_steering) {
      state_.steering = RestingSteering(model_.params(), sample.steering_command);
      state_.steering_actuator = state_.steering;
    }
    valid_ = sample.valid;
    const double elapsed = time - before.time;
    const double speed = 0.5 * (before.speed + state_.speed);
    state_.distance = before.distance + std::abs(speed) * elapsed;
    const WheelSpeeds speeds = RollingSpeeds(model_.params(), speed, state_.steering);
    spin_.resize(static_cast<std::size_t>(speeds.size()));
    for (std::size_t w = 0; w < spin_.size(); ++w) {
      spin_[w] += speeds[static_cast<Eigen::Index>(w)] / model_.params().wheel_radius * elapsed;
    }
  }

  [[nodiscard]] bool valid() const { return valid_; }

  void Step(const Command&) override {}
  void ApplyLateralOffset(double) override {}
  void ApplyLateralForce(double) override {}
  [[nodiscard]] VehicleState Observe() const override { return state_; }
  [[nodiscard]] Pose2 pose() const override { return state_.pose; }
  [[nodiscard]] std::vector<double> Configuration() const override {
    return model_.FlatConfiguration(state_.pose, state_.steering, spin_);
  }
  [[nodiscard]] bool diverged() const override { return false; }

 private:
  const CarModel& model_;
  const RecordedDrive& drive_;
  VehicleState state_;
  bool valid_ = true;
  std::vector<double> spin_;
};

}  // namespace

RunLog RecordedLog(const Scenario& scenario, const CarModel& car) {
  TRACKBED_REQUIRE(scenario.record && scenario.record->data,
                   "SimulateScenario: the plant {} needs a record", kRecordedPlant);
  const RecordedDrive& drive = *scenario.record->data;
  const DriveSpec& spec = scenario.drive;
  RunLog log{.plant = kRecordedPlant, .configurations = Table({"t_s"})};
  ConfigurationLog configurations(car.configuration_columns(), scenario.world, spec.state_period);
  RecordedCar recorded(car, drive);
  const double end = std::min(RunDuration(scenario).value_or(drive.duration()), drive.duration());
  const long periods = static_cast<long>(std::floor(end / spec.control_period + 1e-6));
  const long steps = std::lround(spec.control_period / spec.timestep);
  for (long tick = 0; tick <= periods; ++tick) {
    // Round the times of the log to nanoseconds, as the closed loop does.
    const auto time = [&](long step) {
      const double exact = static_cast<double>(tick) * spec.control_period +
                           static_cast<double>(step) * spec.timestep;
      return std::round(exact * 1e9) / 1e9;
    };
    recorded.MoveTo(time(0));
    const RecordedSample sample = drive.At(time(0));
    LogRow row{.state = recorded.Observe()};
    row.command.steering =
        drive.has_steering_command ? sample.steering_command : row.state.steering;
    row.command.acceleration = drive.has_throttle ? sample.throttle : 0.0;
    row.valid = recorded.valid();
    log.rows.push_back(std::move(row));
    for (long step = 0; step < (tick < periods ? steps : 1); ++step) {
      recorded.MoveTo(time(step));
      configurations.Record(recorded, time(step));
    }
  }
  configurations.RecordEnd(recorded, log.rows.back().state.time);
  log.configurations = configurations.Take();
  return log;
}

}  // namespace trackbed
