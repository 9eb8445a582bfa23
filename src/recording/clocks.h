#pragma once

#include <string>
#include <vector>

#include "src/recording/log_rows.h"
#include "src/recording/signal_delay.h"
#include "trackbed/recording/log_map.h"
#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// The clock of a signal compared with the clock of the pose.
struct SignalClock {
  LogSignal signal = kSpeedSignal;
  SignalDelay found{};
  /// Delay [s] above which the signal counts as delayed. The limit is the maximum of three values:
  /// 3 times the standard error, the mean time between rows of the signal, and the mean time
  /// between rows of the pose. A logger that writes the last value of a signal into each row delays
  /// the signal by up to the time between two rows.
  double uncertainty = 0.0;

  [[nodiscard]] bool differs() const;
};

/// Estimates the delays of all signals of a log that can be compared with the motion (FindDelay).
///
/// The signal `speed` is compared with the derivative of the position along the car. The signal
/// `yaw_rate` is compared with the derivative of the yaw. An accelerometer is compared with the
/// acceleration at its place, which is computed from longitudinal speed, lateral speed and yaw
/// rate. For the accelerometer, measured speeds and yaw rates are first shifted by their delays.
///
/// For `steering` and `steering_command`, the yaw rate is compared with the speed times the tangent
/// of the steering angle. The delay of a steering signal is the time by which the yaw rate follows
/// the steering. A negative delay means that the steering is logged late.
///
/// The samples of `drive` contain the motion that was computed from the pose; `start` is the time
/// of the first sample since the first row of the log [s].
std::vector<SignalClock> MeasureClocks(const LogRows& rows, const LogMap& map,
                                       const RecordedDrive& drive, double start);

/// Returns a note for each signal that is delayed by more than its uncertainty. If `map.align` is
/// true, also shifts the times of these signals in `rows` onto the clock of the pose.
///
/// Steering angles and commands are shifted only if the yaw rate precedes them, which is impossible
/// for a car. Steering signals are shifted by the time by which the yaw rate precedes the steering.
/// If the yaw rate follows the steering, the cause is the response of the car, or a delay, or both;
/// a note states the time between them.
std::vector<std::string> CompareClocks(LogRows& rows, const LogMap& map, const RecordedDrive& drive,
                                       double start);

}  // namespace trackbed
