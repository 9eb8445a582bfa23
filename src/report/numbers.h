#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

/// Reduces numbers for a report page to few digits and few rows.
namespace trackbed {

/// Rounds a number to six significant digits, or to 0 if its magnitude is below 5e-7. The rounding
/// is invisible on a screen and makes the JSON short.
double Rounded(double value);

/// Returns the given rows of a column as a JSON array of rounded numbers.
nlohmann::ordered_json RoundedColumn(const Table& table, const std::string& column,
                                     const std::vector<std::size_t>& rows);

/// Selects rows that preserve the shape of the curves of all columns. A table with at most `limit`
/// rows keeps all rows. A larger table is divided into parts with equal numbers of rows. The
/// selection from a larger table has the first and the last row, and the rows with the minimum and
/// maximum of each column in each part. The selected rows are in order. At most `limit` rows are
/// selected, unless the two end rows and two rows per column exceed `limit`.
std::vector<std::size_t> RowsToShow(const Table& table, std::size_t limit);

}  // namespace trackbed
