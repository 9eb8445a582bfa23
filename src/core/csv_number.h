#pragma once

#include <string>
#include <vector>

namespace trackbed {

/// Returns whether the numbers of a table have decimal commas. In many countries, spreadsheets
/// write decimal commas, and semicolons between cells. `rows` are rows of cells; the delimiter
/// between the cells must not be a comma. Decimal commas are assumed if no number has a point or
/// several commas, and at least one comma is not followed by exactly three digits.
bool HasDecimalCommas(const std::vector<std::vector<std::string>>& rows);

/// Rewrites the number in a cell so that CellNumber reads it: removes the sign +, and replaces a
/// decimal comma by a point if the table has decimal commas. Cells without a number stay unchanged.
void NormalizeNumber(std::string& cell, bool has_decimal_commas);

}  // namespace trackbed
