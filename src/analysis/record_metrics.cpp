#include "trackbed/analysis/record_metrics.h"

#include <cmath>

#include "src/analysis/peaks.h"
#include "trackbed/core/angle.h"
#include "trackbed/recording/relative_rms.h"

namespace trackbed {

std::optional<RecordMetrics> MeasureAgainstRecord(const RunLog& log, const RecordedDrive& record,
                                                  const VehicleParams& vehicle, double min_speed) {
  RecordMetrics metrics;
  RelativeRms yaw_rate;
  RelativeRms lateral;
  double count = 0.0;
  double position_squares = 0.0;
  double heading_squares = 0.0;
  for (const LogRow& row : log.rows) {
    const VehicleState& state = row.state;
    const RecordedSample sample = record.At(state.time);
    if (!sample.valid || state.time > record.duration()) {
      continue;
    }
    count += 1.0;
    const double position = (state.pose.position() - sample.pose.position()).norm();
    const double heading = std::abs(AngleDifference(state.pose.yaw, sample.pose.yaw));
    position_squares += position * position;
    heading_squares += heading * heading;
    metrics.position_final = position;
    if (position > metrics.position_max) {
      metrics.position_max = position;
      metrics.position_max_s = RowStation(row);
      metrics.position_max_t = state.time;
    }
    if (heading > metrics.heading_max) {
      metrics.heading_max = heading;
      metrics.heading_max_s = RowStation(row);
      metrics.heading_max_t = state.time;
    }
    if (std::abs(sample.velocity_V.x()) >= min_speed) {
      const VehicleState recorded = StateOf(sample, vehicle, false);
      yaw_rate.Add(state.yaw_rate, recorded.yaw_rate);
      lateral.Add(state.lateral_acceleration, recorded.lateral_acceleration);
    }
  }
  if (count == 0.0) {
    return std::nullopt;
  }
  metrics.position_rms = std::sqrt(position_squares / count);
  metrics.heading_rms = std::sqrt(heading_squares / count);
  metrics.yaw_rate_relative_rms = yaw_rate.value();
  metrics.lateral_acceleration_relative_rms = lateral.value();
  return metrics;
}

ReplayOptions ReplayOptionsOf(const Scenario& scenario) {
  return {.steering = scenario.record->steering,
          .drive = scenario.record->drive,
          .control_period = scenario.drive.control_period,
          .speed_gain = scenario.control.speed.gain,
          .tyre = scenario.vehicle.tyre,
          .input = scenario.drive.steering,
          .aids = scenario.vehicle.aids.value_or(AidOptions{}),
          .world = scenario.world};
}

std::vector<WindowErrors> MeasureRecordWindows(const Scenario& scenario, const CarModel& car,
                                               const std::string& plant,
                                               const std::function<bool()>& interrupted) {
  const RecordSpec& spec = *scenario.record;
  const RecordedDrive& record = *spec.data;
  ReplayOptions options = ReplayOptionsOf(scenario);
  options.interrupted = interrupted;
  std::vector<WindowErrors> all;
  for (const double horizon : spec.windows) {
    if (interrupted && interrupted()) {
      break;
    }
    const auto predictions =
        PredictWindows(car, plant, record, WindowStarts(record, horizon, horizon, spec.min_speed),
                       horizon, options);
    all.push_back(predictions.empty()
                      ? WindowErrors{.horizon = horizon}
                      : MeasureWindows(predictions, record, car.params(), horizon, spec.min_speed));
  }
  return all;
}

}  // namespace trackbed
