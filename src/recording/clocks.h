#pragma once

#include <string>
#include <vector>

#include "src/recording/log_rows.h"
#include "trackbed/recording/log_map.h"
#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// Estimates the delays of the measured speed, yaw rate and accelerations behind the motion of the
/// pose (FindDelay), and returns a note for each delay that exceeds its uncertainty. If `map.align`
/// is true, also shifts the times of these signals in `rows` by their delays. The samples of
/// `drive` contain the motion that was computed from the pose; `start` is the time of the first
/// sample since the first row of the log [s].
///
/// Also notes by how much the yaw rate follows the steering angle and the steering command. These
/// signals are never shifted, because the response of the car is a part of their delay.
std::vector<std::string> CompareClocks(LogRows& rows, const LogMap& map, const RecordedDrive& drive,
                                       double start);

}  // namespace trackbed
