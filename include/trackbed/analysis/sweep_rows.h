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

/// As records have it.
nlohmann::ordered_json ToJson(const SweepRow& row);
SweepRow RowFromJson(const nlohmann::ordered_json& json);

/// The row of a point's `repetition`; nothing when it was interrupted. Exceptions of a run are its
/// reason, but for RunError, which passes through.
std::optional<SweepRow> MakeRow(const Study& study, const RunScenarioOnce& run,
                                const StudyPoint& point, std::uint64_t repetition);

}  // namespace trackbed
