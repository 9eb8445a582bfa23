#pragma once

#include <string>
#include <vector>

namespace trackbed {

/// Whether the numbers of a table have commas as decimal points, as spreadsheets write them in many
/// countries beside semicolons. `rows` are cells of the table that the delimiter separated, which
/// is no comma. Requires a number whose comma is not before three digits, which a comma between
/// thousands would be, and no number with a point or with several commas.
bool HasDecimalCommas(const std::vector<std::vector<std::string>>& rows);

/// Rewrites the number in a cell so that CellNumber reads it: removes the sign +, and replaces a
/// decimal comma by a point if the table has decimal commas. Does not change other cells.
void NormalizeNumber(std::string& cell, bool has_decimal_commas);

}  // namespace trackbed
