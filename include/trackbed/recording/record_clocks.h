#pragma once

#include <string>
#include <vector>

#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// Compares the speed and the yaw rate of a recorded drive with the derivatives of its pose.
/// Returns a note for the speed or the yaw rate if its delay exceeds both three standard errors and
/// the time between two samples. An example of a note is "yaw_rate lags the motion of the pose by
/// 0.36 s (standard error 0.004 s)". The signals of a recorded drive may be delayed if the log was
/// imported without --align (import_log.h). A fit of car parameters to a drive with a delayed
/// signal would attribute the delay to a lag of the car. ClockNotes does not find delays of more
/// than 1 s. The computing time of ClockNotes is at most 0.2 s.
std::vector<std::string> ClockNotes(const RecordedDrive& drive);

}  // namespace trackbed
