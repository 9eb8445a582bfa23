#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace trackbed {

/// Whether the folder contains a comparison.
bool HasComparison(const std::filesystem::path& folder);

/// The runs compared in the folder, each once: those named in compare.json, else the run in the
/// same folder. Throws InputError if there are none.
std::vector<std::filesystem::path> ComparedRuns(const std::filesystem::path& folder);

/// Differences at equal station: {verdicts, pairs}. Includes the pairs of the comparison in the
/// folder `judged`, if given. Otherwise includes the comparisons in the run folders, and each plant
/// of the first run with the plant of the same name in every other run; for a single run without a
/// comparison, all pairs of its plants. Empty if there are none. Throws InputError if a comparison
/// does not match the logs.
nlohmann::ordered_json ComparisonData(const std::vector<std::filesystem::path>& runs,
                                      const std::optional<std::filesystem::path>& judged);

}  // namespace trackbed
