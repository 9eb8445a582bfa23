#pragma once

#include <cstddef>
#include <string>

#include "trackbed/core/text_table.h"

namespace trackbed::cli {

/// Formats the results of a study. If there are few rows, all are listed. For many rows, each
/// output has its minimum, median and maximum. Headings are those of the study's report. Numbers
/// have four digits, and lines at most `width` characters. A final line names the columns that did
/// not fit.
std::string SweepTableText(const TextTable& table, std::size_t width);

}  // namespace trackbed::cli
