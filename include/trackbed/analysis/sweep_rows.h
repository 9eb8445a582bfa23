#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/sweep.h"
#include "trackbed/scenario/study_points.h"

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

/// Converts a row of a study to the JSON form that SweepRecords stores.
nlohmann::ordered_json ToJson(const SweepRow& row);

/// Reads a row of a study from records, which must contain the row. Throws InputError if a value in
/// the row is not as expected, or if the row does not have one cell for each column.
SweepRow ReadRow(const SweepRecords& records, std::size_t row);

/// Runs the scenario of a point of a study, in the given repetition, and returns the resulting
/// table row; nullopt if the run was interrupted. If the run throws RunError, the error is
/// rethrown; any other exception of the run becomes the reason in the row.
std::optional<SweepRow> MakeRow(const Study& study, const RunScenarioOnce& run,
                                const StudyPoint& point, std::uint64_t repetition);

}  // namespace trackbed
