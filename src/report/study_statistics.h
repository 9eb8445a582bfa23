#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/core/text_table.h"

namespace trackbed {

/// Whether a row with this status counts as passed.
bool HasPassed(const std::string& status);

/// Statistics of all rows of a study: pass rate, and of each output its distribution and the
/// effects of the parameters (statistics.h, 95 % intervals). Null for tables with fewer than 20
/// rows that have a result.
nlohmann::ordered_json StudyStatistics(const TextTable& table);

/// Rows of a study that a page shows individually, in order.
struct ShownRows {
  std::vector<std::size_t> even;      ///< all rows up to `limit`, else `limit` evenly spaced rows
  std::vector<std::size_t> extremes;  ///< if larger: ten extremes of each output at either end
};

ShownRows StudyRowsToShow(const TextTable& table, std::size_t limit);

}  // namespace trackbed
