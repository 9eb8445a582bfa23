#pragma once

#include <optional>

#include "trackbed/drive/run_log.h"
#include "trackbed/recording/recorded_drive.h"
#include "trackbed/recording/windows.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Deviation of a run from the record at equal time, over all log rows at which the record is
/// valid. Relative errors (RelativeRms) only include rows with a recorded speed of at least
/// RecordSpec::min_speed.
struct RecordMetrics {
  double yaw_rate_relative_rms = 0.0;  ///< Relative error of the yaw rate [1].
  /// Relative error of the lateral acceleration at the center of gravity [1].
  double lateral_acceleration_relative_rms = 0.0;
  double position_rms = 0.0;    ///< Root mean square of the distance between the positions [m].
  double position_max = 0.0;    ///< Largest distance between the positions [m].
  double position_max_s = 0.0;  ///< Station of position_max in the log [m].
  double position_max_t = 0.0;  ///< Time of position_max [s].
  double position_final = 0.0;  ///< Distance between the positions at the last compared row [m].
  double heading_rms = 0.0;     ///< Root mean square of the heading difference [rad].
  double heading_max = 0.0;     ///< Largest magnitude of the heading difference [rad].
  double heading_max_s = 0.0;
  double heading_max_t = 0.0;
};

/// Compares a run with the record; nullopt if no row of the log can be compared.
std::optional<RecordMetrics> MeasureAgainstRecord(const RunLog& log, const RecordedDrive& record,
                                                  const VehicleParams& vehicle, double min_speed);

/// The options with which the scenario's record is replayed.
ReplayOptions ReplayOptionsOf(const Scenario& scenario);

/// Prediction errors of the plant over each horizon of the scenario's record. The plant restarts
/// from the record after each horizon. If no window of a horizon is usable (WindowStarts),
/// WindowErrors::count is 0. The function `interrupted` has the meaning of
/// ReplayOptions::interrupted; after an interruption, the remaining horizons are omitted.
std::vector<WindowErrors> MeasureRecordWindows(const Scenario& scenario, const CarModel& car,
                                               const std::string& plant,
                                               const std::function<bool()>& interrupted = {});

}  // namespace trackbed
