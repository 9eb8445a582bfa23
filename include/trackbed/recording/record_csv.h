#pragma once

#include <filesystem>
#include <string>

#include "trackbed/recording/recorded_drive.h"

/// A recorded drive as a file beside the scenario of a run; reading it needs no map.
namespace trackbed {

/// The file name of a recorded drive in the folder of a run.
inline constexpr const char* kRecordCsv = "record.csv";

/// The samples as CSV with all digits; ReadRecordCsv reads them back to equal samples. Columns:
/// `t_s`, `x_m`, `y_m`, `yaw_rad`; of the rear axle, in axes of the vehicle, `speed_mps`,
/// `rear_lateral_speed_mps`, `rear_longitudinal_acceleration_mps2` and
/// `rear_lateral_acceleration_mps2`; `yaw_rate_radps`, `yaw_acceleration_radps2`; `valid`, 0 in
/// gaps; and those of `steering_rad`, `steering_command_rad` and `throttle_mps2` that the drive
/// has.
std::string RecordCsv(const RecordedDrive& drive);

/// Reads a RecordCsv. InputError as ReadCsvExcerpt, for times that are not uniform from 0, and for
/// fewer than two rows.
RecordedDrive ReadRecordCsv(const std::filesystem::path& file);

}  // namespace trackbed
