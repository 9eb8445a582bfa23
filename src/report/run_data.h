#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace trackbed {

/// Name of the log column that the page shows under `name` in a plant's `log`.
const char* ColumnOfChannel(const std::string& name);

/// Whether the folder contains a finished run.
bool IsRunFolder(const std::filesystem::path& folder);

/// Data of one run, shown as `name`, with at most `row_limit` rows per log. RunData throws
/// InputError if the folder does not match its metrics.json.
nlohmann::ordered_json RunData(const std::filesystem::path& folder, const std::string& name,
                               std::size_t row_limit);

/// Whether the run was completed, read from metrics.json only.
bool IsComplete(const std::filesystem::path& folder);

/// Number of plants, read from metrics.json only.
std::size_t PlantCount(const std::filesystem::path& folder);

}  // namespace trackbed
