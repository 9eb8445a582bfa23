#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

/// Reduces the size of a report page by fewer digits per number and fewer rows per table.
namespace trackbed {

/// Rounds a number to six significant digits, or to 0 if its magnitude is below 5e-7. Rounding to
/// six digits is invisible on a screen and makes the JSON shorter.
double Rounded(double value);

/// Returns the values of a table column in the given rows as a JSON array of rounded numbers.
nlohmann::ordered_json RoundedColumn(const Table& table, const std::string& column,
                                     const std::vector<std::size_t>& rows);

/// Selects rows of a table that preserve the shape of the curves of all columns. If the table has
/// at most `limit` rows, RowsToShow selects all of them. A larger table is divided into parts with
/// equal numbers of rows. From such a larger table, RowsToShow selects the first and the last row,
/// and the rows with each column's minimum and maximum in each part. Returns the indices of the
/// selected rows in their order in the table. At most `limit` rows are selected, unless the two end
/// rows and two rows per column exceed `limit`.
std::vector<std::size_t> RowsToShow(const Table& table, std::size_t limit);

}  // namespace trackbed
