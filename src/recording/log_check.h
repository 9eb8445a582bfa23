#pragma once

#include <string>
#include <utility>
#include <vector>

#include "src/recording/log_rows.h"
#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// Finds columns that contradict each other, each with the key of the map to check: headings that
/// turn differently from the path, for example degrees read as radians or with the wrong sign;
/// speeds, yaw rates and steering that disagree with the pose.
///
/// Compares upper quartiles and least-squares fits over the moving part of the drive, so that
/// outliers in single rows have little effect. Drives that hardly turn or move are not judged.
std::vector<std::pair<std::string, std::string>> FindContradictions(const LogRows& rows,
                                                                    const LogMap& map);

}  // namespace trackbed
