#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace trackbed {

/// The log column shown under this name in a plant's `log` on the page.
const char* ColumnOfChannel(const std::string& name);

/// Whether the folder contains a finished run.
bool IsRunFolder(const std::filesystem::path& folder);

/// Data of one run, shown as `name`, with at most `row_limit` rows per log. Throws InputError if
/// the folder does not match its metrics.json.
nlohmann::ordered_json RunData(const std::filesystem::path& folder, const std::string& name,
                               std::size_t row_limit);

/// Whether the run was completed, read from metrics.json only.
bool IsComplete(const std::filesystem::path& folder);

/// Number of plants, read from metrics.json only.
std::size_t PlantCount(const std::filesystem::path& folder);

}  // namespace trackbed
