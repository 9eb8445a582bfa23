#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

/// Numbers for a report page, with few digits and few rows.
namespace trackbed {

/// Rounds to six significant digits, and to 0 below 5e-7. The rounding is finer than a screen, and
/// short in JSON.
double Rounded(double value);

/// The given rows of a column as a JSON array of rounded numbers.
nlohmann::ordered_json RoundedColumn(const Table& table, const std::string& column,
                                     const std::vector<std::size_t>& rows);

/// Selects rows that preserve the shape of all columns. If the table has at most `limit` rows, all
/// are kept. If the table has more than `limit` rows, the selection has the first and last row, and
/// the rows with a column's extremes in equal parts of the table. The selected rows are in order.
/// At most `limit` rows are selected, unless the ends and two rows per column exceed it.
std::vector<std::size_t> RowsToShow(const Table& table, std::size_t limit);

}  // namespace trackbed
