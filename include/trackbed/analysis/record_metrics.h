#pragma once

#include <optional>

#include "trackbed/drive/run_log.h"
#include "trackbed/recording/recorded_drive.h"
#include "trackbed/recording/windows.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Deviation of a run from the recorded drive at equal time, over all log rows at which the record
/// is valid. Relative errors (RelativeRms) only include log rows at which the recorded speed is at
/// least RecordSpec::min_speed.
struct RecordMetrics {
  double yaw_rate_relative_rms = 0.0;  ///< Relative error of the yaw rate [1].
  /// Relative error of the lateral acceleration at the center of gravity [1].
  double lateral_acceleration_relative_rms = 0.0;
  /// Root mean square of the distance between simulated and recorded position [m].
  double position_rms = 0.0;
  double position_max = 0.0;  ///< Largest distance between simulated and recorded position [m].
  /// Station of the simulated car at which the positions differ most [m].
  double position_max_s = 0.0;
  double position_max_t = 0.0;  ///< Time at which the positions differ most [s].
  /// Distance between simulated and recorded position at the last compared log row [m].
  double position_final = 0.0;
  /// Root mean square of the difference between simulated and recorded heading [rad].
  double heading_rms = 0.0;
  /// Largest magnitude of the difference between simulated and recorded heading [rad].
  double heading_max = 0.0;
  double heading_max_s = 0.0;
  double heading_max_t = 0.0;
};

/// Compares a run with the recorded drive; returns nullopt if no row of the log can be compared.
std::optional<RecordMetrics> MeasureAgainstRecord(const RunLog& log, const RecordedDrive& record,
                                                  const VehicleParams& vehicle, double min_speed);

/// Returns the options with which the scenario's record is replayed.
ReplayOptions ReplayOptionsOf(const Scenario& scenario);

/// Computes the prediction errors of the plant for each horizon of the scenario's record. At the
/// end of each horizon, the simulation restarts from the recorded state. If the record has no
/// usable window for a horizon (WindowStarts), WindowErrors::count is 0. The function `interrupted`
/// works as ReplayOptions::interrupted; after an interruption, the remaining horizons are omitted.
std::vector<WindowErrors> MeasureRecordWindows(const Scenario& scenario, const CarModel& car,
                                               const std::string& plant,
                                               const std::function<bool()>& interrupted = {});

}  // namespace trackbed
