#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

/// Numbers as a page needs them: short, and not too many.
namespace trackbed {

/// Six significant digits, and 0 below 5e-7: finer than any screen, and short in JSON.
double Rounded(double value);

/// The column as a JSON array of rounded numbers, of the rows alone that are asked for.
nlohmann::ordered_json RoundedColumn(const Table& table, const std::string& column,
                                     const std::vector<std::size_t>& rows);

/// Rows of a table that show what all of them would: all when there are at most `limit`, else those
/// where a column has its largest or smallest value of a stretch, and the first and the last one.
/// In order; at most `limit`, unless two for every column and the ends are more.
std::vector<std::size_t> RowsToShow(const Table& table, std::size_t limit);

}  // namespace trackbed
