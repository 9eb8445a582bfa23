#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace trackbed {

/// Reads columns of a CSV file of any length as a stream. Calls `take` for each row, with the
/// numbers in the order of `columns` and the line on which the row begins. The names in `columns`
/// must be distinct. Cells of the column `timestamps` may also be timestamps, which are passed on
/// as seconds since 1970, or times of day, as seconds since midnight (TimestampOrTimeOfDay). An
/// empty cell is passed to `take` as NaN. Cells that are NaN or infinite are also passed to `take`,
/// and the number of cells is not limited. For all other problems that ReadCsvExcerpt rejects,
/// throws InputError after the last row. Throws RunError in the same cases as ReadFile.
void ReadCsvColumns(const std::filesystem::path& file, const std::vector<std::string>& columns,
                    char delimiter, const std::string& timestamps,
                    const std::function<void(const std::vector<double>& numbers, int line)>& take);

/// Returns the names of the columns of a CSV file from another program, and counts its rows. Throws
/// InputError if the file has no names or is not valid CSV. Throws RunError in the same cases as
/// ReadFile.
std::vector<std::string> ReadCsvNames(const std::filesystem::path& file, std::size_t& rows);

}  // namespace trackbed
