#pragma once

#include <filesystem>
#include <string>

#include "trackbed/recording/recorded_drive.h"

/// A recorded drive as a file of its own, which a run keeps beside its scenario: no map is needed
/// to read it.
namespace trackbed {

/// The name of a recorded drive in the folder of a run.
inline constexpr const char* kRecordCsv = "record.csv";

/// The samples as CSV, every digit of them, which ReadRecordCsv reads back to equal ones. Columns:
/// `t_s`, `x_m`, `y_m`, `yaw_rad`; of the rear axle, in axes of the vehicle, `speed_mps`,
/// `rear_lateral_speed_mps`, `rear_longitudinal_acceleration_mps2` and
/// `rear_lateral_acceleration_mps2`; `yaw_rate_radps`, `yaw_acceleration_radps2`; `valid`, 0 in
/// gaps; and of `steering_rad`, `steering_command_rad` and `throttle_mps2` those that there are.
std::string RecordCsv(const RecordedDrive& drive);

/// InputError as ReadCsvExcerpt, and for times that are not uniform from 0 on, or fewer than two
/// rows.
RecordedDrive ReadRecordCsv(const std::filesystem::path& file);

}  // namespace trackbed
