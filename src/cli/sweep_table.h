#pragma once

#include <cstddef>
#include <string>

#include "trackbed/core/text_table.h"

namespace trackbed::cli {

/// Formats the results of a study: all rows if they are few, else minimum, median and maximum of
/// each output. Headings as in its report, numbers with four digits, lines of at most `width`
/// characters. A final line names what did not fit.
std::string SweepTableText(const TextTable& table, std::size_t width);

}  // namespace trackbed::cli
