#pragma once

#include <filesystem>
#include <string>

#include "trackbed/recording/recorded_drive.h"

/// Reads and writes a recorded drive as a file in the run folder. The file of a recorded drive can
/// be read without a log map.
namespace trackbed {

/// The file name of a recorded drive in a run folder.
inline constexpr const char* kRecordCsv = "record.csv";

/// Formats the samples of a recorded drive as CSV with full precision, so that ReadRecordCsv reads
/// equal samples. The CSV has the columns `t_s`, `x_m`, `y_m`, `yaw_rad`, `yaw_rate_radps` and
/// `yaw_acceleration_radps2`. The columns `speed_mps`, `rear_lateral_speed_mps`,
/// `rear_longitudinal_acceleration_mps2` and `rear_lateral_acceleration_mps2` are for the rear axle
/// in the axes of the vehicle. The column `valid` is 0 for samples in gaps of the log. The columns
/// `steering_rad`, `steering_command_rad` and `throttle_mps2` are present if the drive has these
/// signals.
std::string RecordCsv(const RecordedDrive& drive);

/// Reads a file in the format of RecordCsv. Throws InputError in the same cases as ReadCsvExcerpt.
/// Also throws InputError if the times do not start at 0, are not evenly spaced, or if there are
/// fewer than two rows.
RecordedDrive ReadRecordCsv(const std::filesystem::path& file);

}  // namespace trackbed
