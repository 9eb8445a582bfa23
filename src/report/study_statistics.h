#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/core/text_table.h"

namespace trackbed {

/// Whether a row with this status counts as passed.
bool HasPassed(const std::string& status);

/// Statistics of all rows of a study. The statistics are the pass rate, the distribution of each
/// output and the effects of the parameters on the outputs (statistics.h, 95 % intervals).
/// StudyStatistics is null for tables in which fewer than 20 rows have a result.
nlohmann::ordered_json StudyStatistics(const TextTable& table);

/// Rows of a study that a page shows individually, in the order of the table.
struct ShownRows {
  std::vector<std::size_t> even;      ///< All rows if there are at most `limit`, else `limit`
                                      ///< evenly spaced rows.
  std::vector<std::size_t> extremes;  ///< In a larger study, the ten lowest and ten highest values
                                      ///< of each output.
};

ShownRows StudyRowsToShow(const TextTable& table, std::size_t limit);

}  // namespace trackbed
