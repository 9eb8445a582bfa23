#pragma once

#include <filesystem>
#include <string>

#include "trackbed/recording/recorded_drive.h"

/// A recorded drive as a file in the run folder. Reading this file needs no log map.
namespace trackbed {

/// The file name of a recorded drive in the folder of a run.
inline constexpr const char* kRecordCsv = "record.csv";

/// Formats the samples as CSV with full precision; ReadRecordCsv restores equal samples. Columns:
/// `t_s`, `x_m`, `y_m`, `yaw_rad`; `speed_mps`, `rear_lateral_speed_mps`,
/// `rear_longitudinal_acceleration_mps2` and `rear_lateral_acceleration_mps2` of the rear axle, in
/// axes of the vehicle; `yaw_rate_radps`, `yaw_acceleration_radps2`; `valid`, which is 0 in gaps.
/// The columns `steering_rad`, `steering_command_rad` and `throttle_mps2` are present if the drive
/// has them.
std::string RecordCsv(const RecordedDrive& drive);

/// Reads a file that RecordCsv formatted. Throws the InputErrors of ReadCsvExcerpt. InputError for
/// times that are not uniform from 0, and for fewer than two rows.
RecordedDrive ReadRecordCsv(const std::filesystem::path& file);

}  // namespace trackbed
