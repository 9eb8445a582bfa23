#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/sweep.h"
#include "trackbed/scenario/study.h"

namespace trackbed {

/// One row of a study's table.
struct SweepRow {
  std::vector<std::string> cells;
  bool passed = false;
  bool refused = false;
  bool error = false;
  std::size_t runs = 1;
  nlohmann::ordered_json bisection;
};

/// Converts a row to the form in which records store it.
nlohmann::ordered_json ToJson(const SweepRow& row);

/// Reads a row of records, which must be present. Throws the InputErrors of JsonValue. InputError
/// unless the row has a cell for each column.
SweepRow ReadRow(const SweepRecords& records, std::size_t row);

/// Runs the scenario of a point, in the given repetition, and returns the table row; nullopt if
/// interrupted. A RunError is rethrown; any other exception of the run becomes the reason of the
/// row.
std::optional<SweepRow> MakeRow(const Study& study, const RunScenarioOnce& run,
                                const StudyPoint& point, std::uint64_t repetition);

}  // namespace trackbed
