#pragma once

#include <filesystem>
#include <vector>

#include "src/recording/log_rows.h"

namespace trackbed {

/// Projects the positions of the rows, which are longitudes and latitudes [deg], to meters. Drops
/// rows without a fix. `lines` are the lines of the rows. Adds notes. Throws InputError if a
/// position is too far from the origin.
void ProjectRows(const std::filesystem::path& log, const LogPosition& map, std::vector<int>& lines,
                 LogRows& rows);

/// Refuses a CSV file that has letters for south or west in a column of their own beside positive
/// numbers, because the numbers would be read as north or east. Throws InputError with the lines.
void CheckHemispheres(const std::filesystem::path& log, const LogPosition& map, char delimiter);

/// Takes the direction of motion as the yaw; below 0.5 m/s, the last yaw. Adds a note. Throws
/// InputError if the position never moves faster.
void TakeHeadings(const std::filesystem::path& log, const LogMap& map, LogRows& rows);

}  // namespace trackbed
