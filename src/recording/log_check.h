#pragma once

#include <string>
#include <utility>
#include <vector>

#include "src/recording/log_rows.h"
#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// Columns that contradict each other, each with the key of the map to look at: headings that turn
/// in another way than the path, in degrees that are read as radians or with the wrong sign;
/// speeds, yaw rates and steering that do not go with the pose.
///
/// What is compared are upper quartiles and least squares over the moving part of the drive, so
/// that jumps of single rows do not matter. A drive that hardly turns or moves is not judged.
std::vector<std::pair<std::string, std::string>> FindContradictions(const LogRows& rows,
                                                                    const LogMap& map);

}  // namespace trackbed
