#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "trackbed/core/text_table.h"

namespace trackbed {

/// Data of the search whose runs are in `table`, read from `file`. The data has the outcome of the
/// search, the margins and the tried parts of the range of each key, and the best run so far.
/// SearchData is null if `file` is not in the folder of a search.
///
/// Throws InputError naming the file if falsify.json or sweep.json is invalid. SearchData also
/// throws if falsify.json describes other runs than the table.
nlohmann::ordered_json SearchData(const std::filesystem::path& file, const TextTable& table);

}  // namespace trackbed
