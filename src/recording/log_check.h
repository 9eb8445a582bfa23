#pragma once

#include <string>
#include <utility>
#include <vector>

#include "src/recording/log_rows.h"
#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// Finds columns of a log that contradict each other, and returns for each contradiction the key of
/// the log's map that the user should check. For example, if degrees are read as radians or the
/// sign is wrong, the heading turns differently from the path. Speeds, yaw rates and steering are
/// compared with the motion of the pose.
///
/// The check compares upper quartiles and least-squares fits over the moving part of the drive.
/// Because the check uses upper quartiles and fits, outliers in single rows have little effect.
/// The check does not judge drives in which the vehicle hardly turns or moves.
std::vector<std::pair<std::string, std::string>> FindContradictions(const LogRows& rows,
                                                                    const LogMap& map);

}  // namespace trackbed
