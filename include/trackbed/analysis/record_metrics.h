#pragma once

#include <optional>

#include "trackbed/drive/run_log.h"
#include "trackbed/recording/recorded_drive.h"
#include "trackbed/recording/windows.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// How far a run is from the record, at equal time: over all rows of the log at which the record is
/// valid. Relative errors (RelativeRms) are over those at which the recorded speed is at least
/// RecordSpec::min_speed.
struct RecordMetrics {
  double yaw_rate_relative_rms = 0.0;              ///< [1]
  double lateral_acceleration_relative_rms = 0.0;  ///< at the center of gravity [1]
  double position_rms = 0.0;                       ///< of the distance [m]
  double position_max = 0.0;                       ///< [m]
  double position_max_s = 0.0;                     ///< where in the log [m]
  double position_max_t = 0.0;                     ///< when [s]
  double position_final = 0.0;                     ///< at the last such row [m]
  double heading_rms = 0.0;                        ///< [rad]
  double heading_max = 0.0;                        ///< largest magnitude [rad]
  double heading_max_s = 0.0;
  double heading_max_t = 0.0;
};

/// None when no row of the log can be compared.
std::optional<RecordMetrics> MeasureAgainstRecord(const RunLog& log, const RecordedDrive& record,
                                                  const VehicleParams& vehicle, double min_speed);

/// How a scenario with a record replays it.
ReplayOptions ReplayOptionsOf(const Scenario& scenario);

/// The predictions of the plant over every horizon of the scenario's record, restarted as often as
/// it is long. Without windows (WindowStarts) the count is 0. `interrupted` as in ReplayOptions;
/// what is missing then is left out.
std::vector<WindowErrors> MeasureRecordWindows(const Scenario& scenario, const CarModel& car,
                                               const std::string& plant,
                                               const std::function<bool()>& interrupted = {});

}  // namespace trackbed
