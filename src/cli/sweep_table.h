#pragma once

#include <cstddef>
#include <string>

#include "trackbed/core/text_table.h"

namespace trackbed::cli {

/// What a study gave, to print: its rows if they are few, else the least, the middle and the
/// largest value of each output; with headings as on its page, numbers with four digits, and no
/// wider than `width` characters. Ends with a line that says what did not fit.
std::string SweepTableText(const TextTable& table, std::size_t width);

}  // namespace trackbed::cli
