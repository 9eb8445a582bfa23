#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/recording/log_map.h"

namespace trackbed {

/// Signals that a log may contain in addition to the pose.
enum LogSignal : std::size_t {
  kSpeedSignal,
  kYawRateSignal,
  kAccelerationX,
  kAccelerationY,
  kSteeringSignal,
  kSteeringCommandSignal,
  kThrottleSignal,
  kLogSignals,
};

/// Keys of the signals in a log map (the file that describes a log's columns), in the order of
/// LogSignal.
inline constexpr std::array<const char*, kLogSignals> kLogSignalKeys{
    "speed",    "yaw_rate",         "accelerometer", "accelerometer",
    "steering", "steering_command", "throttle"};

/// Values of a signal at the log rows that contain the signal.
struct LogSeries {
  std::vector<double> time;   // Time since the first row of the log, increasing [s].
  std::vector<double> value;  // Values of the signal in SI units, positive forward and to the left.
};

/// Rows of a log that the reader has not skipped, in SI units and ENU axes.
struct LogRows {
  std::vector<double> time{};    // Time since the first row of the log, strictly increasing [s].
  std::vector<Vec2> position{};  // Position of the measured point [m].
  // Logged yaw angle of the measured axes, which may jump by multiples of 2 pi [rad].
  std::vector<double> yaw{};
  std::array<LogSeries, kLogSignals> signals{};
  // For each signal, whether the log map (the file that describes the log's columns) specifies a
  // column for the signal.
  std::array<bool, kLogSignals> has{};
  double origin = 0.0;           // Time of the first row, in the log's time unit.
  std::size_t rows = 0;          // Number of rows in the log.
  std::size_t invalid = 0;       // Number of rows that a condition of the log map excludes.
  std::size_t without_pose = 0;  // Number of log rows without a complete pose.
  std::size_t repeated = 0;      // Number of rows with the same time as the previous row.
  // Line number of the first row that has the same time as the previous row.
  int repeated_line = 0;
  std::vector<std::string> notes{};  // Notes on how geographic positions were projected to a plane.
};

/// Reads the rows of the log and of the other files that the log map names. ReadLogRows throws
/// InputError under the same conditions as ImportLog.
LogRows ReadLogRows(const std::filesystem::path& log, const LogMap& map);

/// Returns an error message with a remedy if most rows are farther apart than `gap` [s], so that
/// nearly all samples would be in gaps; else "".
std::string GapProblem(const std::vector<double>& time, double gap);

/// Removes jumps by multiples of 2 pi from a series of yaw angles.
void Unwrap(std::vector<double>& yaw);

}  // namespace trackbed
