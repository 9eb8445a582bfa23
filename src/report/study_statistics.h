#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/core/text_table.h"

namespace trackbed {

/// Whether a row of a study with the status `status` counts as passed.
bool HasPassed(const std::string& status);

/// Computes statistics over all rows of a study: the pass rate, the distribution of each output and
/// the effects of the parameters on the outputs (statistics.h, 95 % intervals). StudyStatistics
/// returns null if fewer than 20 rows have a result.
nlohmann::ordered_json StudyStatistics(const TextTable& table);

/// Indices of the rows of a study that a page shows individually.
struct ShownRows {
  /// All rows of the study if there are at most `limit`, else `limit` evenly spaced rows.
  std::vector<std::size_t> even;
  /// If the study has more than `limit` rows: the rows with the ten lowest and ten highest values
  /// of each output.
  std::vector<std::size_t> extremes;
};

ShownRows StudyRowsToShow(const TextTable& table, std::size_t limit);

}  // namespace trackbed
