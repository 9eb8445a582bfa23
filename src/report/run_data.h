#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace trackbed {

/// The column of a log that a page calls so in a plant's `log`.
const char* ColumnOfChannel(const std::string& name);

/// What a finished run leaves beside its logs and that tells one from any other folder.
bool IsRunFolder(const std::filesystem::path& folder);

/// What the page shows of one run, which it calls `name`; at most `row_limit` rows of each log.
/// InputError when the folder does not hold what its metrics.json says.
nlohmann::ordered_json RunData(const std::filesystem::path& folder, const std::string& name,
                               std::size_t row_limit);

/// Whether a run was not interrupted, from its metrics.json alone.
bool IsComplete(const std::filesystem::path& folder);

/// The plants of a run, from its metrics.json alone.
std::size_t PlantCount(const std::filesystem::path& folder);

}  // namespace trackbed
