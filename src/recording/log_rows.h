#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/recording/log_map.h"

namespace trackbed {

/// Signals of a log besides the pose.
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

/// A signal at the rows that contain it.
struct LogSeries {
  std::vector<double> time;   // since the first row of the log, increasing [s]
  std::vector<double> value;  // SI, positive forward and to the left
};

/// The selected rows of a log, in SI units and ENU axes.
struct LogRows {
  std::vector<double> time{};    // since the first row of the log, strictly increasing [s]
  std::vector<Vec2> position{};  // of the measured point [m]
  std::vector<double> yaw{};  // of the measured axes, as logged: may jump by whole turns [rad]
  std::array<LogSeries, kLogSignals> signals{};
  std::array<bool, kLogSignals> has{};  // whether the map names the signal
  double origin = 0.0;                  // time of the first row, in the log's unit
  std::size_t rows = 0;                 // in the log
  std::size_t invalid = 0;              // rows that a condition of the map excludes
  std::size_t without_pose = 0;         // rows without a number for the pose
  std::size_t repeated = 0;             // rows that repeat the time of the row before
  int repeated_line = 0;                // line of the first such row
};

/// Reads the log and the other files that the map names. InputError as ImportLog.
LogRows ReadLogRows(const std::filesystem::path& log, const LogMap& map);

/// Removes jumps by whole turns.
void Unwrap(std::vector<double>& yaw);

}  // namespace trackbed
