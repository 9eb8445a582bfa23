#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace trackbed {

/// Whether the folder contains a comparison.
bool HasComparison(const std::filesystem::path& folder);

/// The runs compared in the folder, each once: those named in compare.json, else the run in the
/// same folder. ComparedRuns throws InputError if there are no runs.
std::vector<std::filesystem::path> ComparedRuns(const std::filesystem::path& folder);

/// Differences at equal station, as {verdicts, pairs}. If the folder `judged` is given, the data
/// has the pairs of its comparison. Without `judged`, the data has the comparisons in the run
/// folders, and each plant of the first run with the plant of the same name in every other run. For
/// a single run without a comparison, the data has all pairs of plants. ComparisonData is empty if
/// there are no pairs. ComparisonData throws InputError if a comparison does not match the logs.
nlohmann::ordered_json ComparisonData(const std::vector<std::filesystem::path>& runs,
                                      const std::optional<std::filesystem::path>& judged);

}  // namespace trackbed
