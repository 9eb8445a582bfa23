#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/recording/log_map.h"

namespace trackbed {

/// Signals of a log in addition to the pose.
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

/// Key of each signal in a map.
inline constexpr std::array<const char*, kLogSignals> kLogSignalKeys{
    "speed",    "yaw_rate",         "accelerometer", "accelerometer",
    "steering", "steering_command", "throttle"};

/// A signal, with values at the rows that contain it.
struct LogSeries {
  std::vector<double> time;   // Time since the first row of the log, increasing [s].
  std::vector<double> value;  // Values in SI units, positive forward and to the left.
};

/// The selected rows of a log, in SI units and ENU axes.
struct LogRows {
  std::vector<double> time{};    // Time since the first row of the log, strictly increasing [s].
  std::vector<Vec2> position{};  // Position of the measured point [m].
  std::vector<double> yaw{};  // Yaw of the measured axes as logged, which may jump by whole turns
                              // [rad].
  std::array<LogSeries, kLogSignals> signals{};
  std::array<bool, kLogSignals> has{};  // For each signal, whether the map names it.
  double origin = 0.0;                  // Time of the first row, in the log's unit.
  std::size_t rows = 0;                 // Number of rows in the log.
  std::size_t invalid = 0;              // Rows that a condition of the map excludes.
  std::size_t without_pose = 0;         // Rows without a number for the pose.
  std::size_t repeated = 0;             // Rows that repeat the time of the row before.
  int repeated_line = 0;                // Line of the first row that repeats a time.
};

/// Reads the rows of the log and of the other files that the map names. ReadLogRows throws
/// InputError under the same conditions as ImportLog.
LogRows ReadLogRows(const std::filesystem::path& log, const LogMap& map);

/// Removes jumps by whole turns from a series of yaw angles.
void Unwrap(std::vector<double>& yaw);

}  // namespace trackbed
