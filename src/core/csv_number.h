#pragma once

#include <string>
#include <vector>

namespace trackbed {

/// Returns whether the numbers of a table have decimal commas, as spreadsheets write them in many
/// countries, with semicolons between cells. `rows` are rows of cells; the delimiter between the
/// cells is not a comma. Returns true if no number has a point or several commas, and if at least
/// one comma is not followed by three digits, as a comma between thousands is.
bool HasDecimalCommas(const std::vector<std::vector<std::string>>& rows);

/// Rewrites the number in a cell so that CellNumber reads it: removes the sign +, and replaces a
/// decimal comma by a point if the table has decimal commas. Cells without a number stay unchanged.
void NormalizeNumber(std::string& cell, bool has_decimal_commas);

}  // namespace trackbed
