#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace trackbed {

/// Returns the name of the column of a plant's log file that is called `name` in the page's data.
const char* ColumnOfChannel(const std::string& name);

/// Returns whether the folder contains the files of a finished run.
bool IsRunFolder(const std::filesystem::path& folder);

/// Returns the data of one run, with at most `row_limit` rows per log. `name` is the name of the
/// run on the page. Throws InputError if the files in the folder do not match its metrics.json.
nlohmann::ordered_json RunData(const std::filesystem::path& folder, const std::string& name,
                               std::size_t row_limit);

/// Whether the run was completed and not interrupted. Reads only metrics.json.
bool IsComplete(const std::filesystem::path& folder);

/// Returns the number of plants in the run. Reads only metrics.json.
std::size_t PlantCount(const std::filesystem::path& folder);

}  // namespace trackbed
