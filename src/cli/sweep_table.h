#pragma once

#include <cstddef>
#include <string>

#include "trackbed/core/text_table.h"

namespace trackbed::cli {

/// Formats the results of a study as a table. A study with few rows is printed row by row. For a
/// study with many rows, the table shows minimum, median and maximum of each output. The headings
/// are the same as in the study's report. Numbers have four digits, and lines have at most `width`
/// characters. A final line names the columns that did not fit.
std::string SweepTableText(const TextTable& table, std::size_t width);

}  // namespace trackbed::cli
