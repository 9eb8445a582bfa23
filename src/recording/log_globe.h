#pragma once

#include <filesystem>
#include <vector>

#include "src/recording/log_rows.h"

namespace trackbed {

/// Projects the positions of the rows, which are longitudes and latitudes [deg], to meters. Drops
/// rows without a fix. `lines` contains the line number of each row. Adds notes. Throws InputError
/// if a position is too far from the origin.
void ProjectRows(const std::filesystem::path& log, const LogPosition& map, std::vector<int>& lines,
                 LogRows& rows);

/// Refuses a CSV file that marks south or west by letters in a separate column while its numbers
/// are positive, because the numbers would be read as north or east. Throws InputError that names
/// the lines of the contradictory rows.
void CheckHemispheres(const std::filesystem::path& log, const LogPosition& map, char delimiter);

/// Sets the yaw of each row to the direction of motion. Below 0.5 m/s, repeats the last yaw. Adds a
/// note. Throws InputError if the speed is below 0.5 m/s in all rows.
void TakeHeadings(const std::filesystem::path& log, const LogMap& map, LogRows& rows);

}  // namespace trackbed
