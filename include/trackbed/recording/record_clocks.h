#pragma once

#include <string>
#include <vector>

#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// Compares the speed and the yaw rate of a recorded drive with the derivatives of its pose.
/// Returns a note for each that is delayed by more than three standard errors and one sample. An
/// example is "yaw_rate lags the motion of the pose by 0.36 s (standard error 0.004 s)". A drive
/// with a delay was imported without --align (import_log.h), and parameters that are fitted to it
/// would explain the delay by a lag of the car. Delays of more than 1 s are not found. The cost is
/// at most 0.2 s.
std::vector<std::string> ClockNotes(const RecordedDrive& drive);

}  // namespace trackbed
