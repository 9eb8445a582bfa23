#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "trackbed/core/text_table.h"

namespace trackbed {

/// Returns the data of a search for failures; `table` contains the runs of the search and was read
/// from `file`. The search data consist of the outcome of the search, the margins of each key, and
/// the tried parts of each key's range. The search data also contain each new lowest robustness,
/// with the run that reached it. SearchData returns null if `file` is not in the folder of a
/// search.
///
/// Throws InputError naming the file if falsify.json or sweep.json is invalid, or if falsify.json
/// does not describe the runs in the table.
nlohmann::ordered_json SearchData(const std::filesystem::path& file, const TextTable& table);

}  // namespace trackbed
