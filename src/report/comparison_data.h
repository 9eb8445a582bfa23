#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace trackbed {

/// Whether the folder contains the result of a comparison.
bool HasComparison(const std::filesystem::path& folder);

/// Returns the folders of the compared runs, each once: those named in compare.json or, if none is
/// named, the folder of compare.json itself. Throws InputError if there are no runs.
std::vector<std::filesystem::path> ComparedRuns(const std::filesystem::path& folder);

/// Returns the differences between plants at equal station, as {verdicts, pairs}. If the folder
/// `judged` is given, the pairs are those of the comparison in this folder. Otherwise the pairs are
/// those of comparisons in the run folders, and each plant of the first run with the plant of the
/// same name in every other run. For a single run without a comparison, the pairs are all pairs of
/// its plants. The result is empty if there are no pairs. Throws InputError if a comparison does
/// not match the logs.
nlohmann::ordered_json ComparisonData(const std::vector<std::filesystem::path>& runs,
                                      const std::optional<std::filesystem::path>& judged);

}  // namespace trackbed
