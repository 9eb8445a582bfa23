#pragma once

#include <cstddef>
#include <string>

#include "trackbed/core/text_table.h"

namespace trackbed::cli {

/// Formats the results of a study as a table. A study with few rows is printed row by row. For a
/// study with many rows, the table shows minimum, median and maximum of each output. The column
/// headings are the same as in the report of the study. Numbers have four digits, and lines have at
/// most `width` characters. If some columns do not fit into `width`, a final line names these
/// columns.
std::string SweepTableText(const TextTable& table, std::size_t width);

}  // namespace trackbed::cli
