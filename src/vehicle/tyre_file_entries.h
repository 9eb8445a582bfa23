#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/table.h"

namespace trackbed {

/// A line `KEY = value` of a tyre property file.
struct TyreFileEntry {
  std::string section;  ///< Name of the section in capitals; empty before the first section.
  std::string key;      ///< In capitals.
  std::string text;     ///< Value of the entry as text without quotes.
  int line = 0;         ///< Line number from 1.
  std::optional<double> number;  ///< Value of the entry, if it is a number.
};

/// Splits a tyre property file into its entries, in the order of the file. Entries of the tyre file
/// without a value are left out. Adds a problem for each malformed line of the tyre file.
std::vector<TyreFileEntry> SplitTyreFile(std::string_view text, const std::string& name,
                                         ProblemList& problems);

/// Returns `text` with ASCII letters in capitals.
std::string InCapitals(std::string_view text);

}  // namespace trackbed
