#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

/// Numbers for a page: few digits and few rows.
namespace trackbed {

/// Rounds to six significant digits, and to 0 below 5e-7: finer than a screen, and short in JSON.
double Rounded(double value);

/// The given rows of a column as a JSON array of rounded numbers.
nlohmann::ordered_json RoundedColumn(const Table& table, const std::string& column,
                                     const std::vector<std::size_t>& rows);

/// Rows that preserve the shape of all columns: all rows if there are at most `limit`, else the
/// first, the last, and the rows with a column's extremes in equal parts of the table. In order; at
/// most `limit`, unless the ends and two rows per column exceed it.
std::vector<std::size_t> RowsToShow(const Table& table, std::size_t limit);

}  // namespace trackbed
