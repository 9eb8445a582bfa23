#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/core/text_table.h"

namespace trackbed {

/// Whether a row with this status is a success.
bool HasPassed(const std::string& status);

/// What the page of a study says about all its rows together: the pass rate, and of each output its
/// distribution and what the parameters do to it (statistics.h, 95 % intervals). Null of a table
/// with fewer than 20 rows that have a result.
nlohmann::ordered_json StudyStatistics(const TextTable& table);

/// The rows of a study that a page has one by one, in order.
struct ShownRows {
  std::vector<std::size_t> even;      ///< all of at most `limit`, else as many, evenly spaced
  std::vector<std::size_t> extremes;  ///< of a big study, also the ten ends of each output
};

ShownRows StudyRowsToShow(const TextTable& table, std::size_t limit);

}  // namespace trackbed
