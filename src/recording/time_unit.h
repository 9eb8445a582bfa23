#pragma once

#include <filesystem>
#include <string>

#include "trackbed/recording/log_map.h"

namespace trackbed {

/// Returns the unit of the times of a CSV log, whose names do not state the unit: the longest of s,
/// ms, us and ns with which the rows are those of a drive. The rows of a drive are at most 33 s
/// apart, and the mean speed is 0.1 to 100 m/s. Returns "s" if no unit has these properties, if the
/// times are timestamps, or if `step`, the median step of the times in the unit of the log, is at
/// most 1. Reads the columns of time and position that `map` names. Throws InputError if a cell of
/// the position is no number.
std::string TimeUnitOf(const std::filesystem::path& log, const LogMap& map, double step);

}  // namespace trackbed
