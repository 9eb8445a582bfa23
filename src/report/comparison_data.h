#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace trackbed {

/// Whether the folder contains the result of a comparison of runs.
bool HasComparison(const std::filesystem::path& folder);

/// Returns the folders of the compared runs without duplicates: those named in compare.json or, if
/// none is named, the folder of compare.json itself. If the compared folders contain no runs,
/// throws InputError.
std::vector<std::filesystem::path> ComparedRuns(const std::filesystem::path& folder);

/// Returns the differences between pairs of plants at equal stations, as {verdicts, pairs}. If
/// `judged` is given, the pairs of plants are those of the comparison in the folder `judged`.
/// Without a folder `judged`, the pairs of plants are those of the comparisons in the run folders.
/// Each plant of the first run is also paired with the plant of the same name in every other run.
/// For a single run without a comparison, all pairs of its plants are compared. Returns an empty
/// result if there are no pairs of plants. Throws InputError if a stored comparison does not match
/// the logs of its runs.
nlohmann::ordered_json ComparisonData(const std::vector<std::filesystem::path>& runs,
                                      const std::optional<std::filesystem::path>& judged);

}  // namespace trackbed
