#pragma once

#include <optional>

#include "trackbed/drive/run_log.h"
#include "trackbed/recording/recorded_drive.h"
#include "trackbed/recording/windows.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Deviation of a run from the record at equal time, over all rows of the log at which the record
/// is valid. Relative errors (RelativeRms) include only rows at which the recorded speed is at
/// least RecordSpec::min_speed.
struct RecordMetrics {
  double yaw_rate_relative_rms = 0.0;              ///< [1]
  double lateral_acceleration_relative_rms = 0.0;  ///< at the center of gravity [1]
  double position_rms = 0.0;                       ///< of the distance [m]
  double position_max = 0.0;                       ///< [m]
  double position_max_s = 0.0;                     ///< station in the log [m]
  double position_max_t = 0.0;                     ///< when [s]
  double position_final = 0.0;                     ///< at the last compared row [m]
  double heading_rms = 0.0;                        ///< [rad]
  double heading_max = 0.0;                        ///< largest magnitude [rad]
  double heading_max_s = 0.0;
  double heading_max_t = 0.0;
};

/// None when no row of the log can be compared.
std::optional<RecordMetrics> MeasureAgainstRecord(const RunLog& log, const RecordedDrive& record,
                                                  const VehicleParams& vehicle, double min_speed);

/// The options with which a scenario replays its record.
ReplayOptions ReplayOptionsOf(const Scenario& scenario);

/// Prediction errors of the plant over every horizon of the scenario's record; the plant restarts
/// at the record after each horizon. The count is 0 without windows (WindowStarts). `interrupted`
/// as in ReplayOptions; horizons not evaluated by then are left out.
std::vector<WindowErrors> MeasureRecordWindows(const Scenario& scenario, const CarModel& car,
                                               const std::string& plant,
                                               const std::function<bool()>& interrupted = {});

}  // namespace trackbed
