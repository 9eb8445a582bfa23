#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace trackbed {

/// Whether drives have been compared and the outcome written to the folder.
bool HasComparison(const std::filesystem::path& folder);

/// The runs that the folder's comparison is of, each once: those that it names, or the run that it
/// lies beside. InputError when it tells of none.
std::vector<std::filesystem::path> ComparedRuns(const std::filesystem::path& folder);

/// How far drives part at equal station: {verdicts, pairs}. Those of the comparison in the folder
/// `judged`, if there is one, else those of the comparisons that lie beside the runs, and each
/// plant of the first run with its namesake in every other; of a run alone that has not been
/// compared, each two of its plants. Empty when that is nothing. InputError
/// when a comparison is not of the logs in the folders.
nlohmann::ordered_json ComparisonData(const std::vector<std::filesystem::path>& runs,
                                      const std::optional<std::filesystem::path>& judged);

}  // namespace trackbed
