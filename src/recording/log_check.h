#pragma once

#include <string>
#include <utility>
#include <vector>

#include "src/recording/log_rows.h"
#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// Finds columns that contradict each other, each with the map key to check. A heading may turn
/// differently from the path, for example if degrees are read as radians or the sign is wrong.
/// Speeds, yaw rates and steering may disagree with the pose.
///
/// The check compares upper quartiles and least-squares fits over the moving part of the drive.
/// Outliers in single rows therefore have little effect. Drives that hardly turn or move are not
/// judged.
std::vector<std::pair<std::string, std::string>> FindContradictions(const LogRows& rows,
                                                                    const LogMap& map);

}  // namespace trackbed
