#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "trackbed/core/text_table.h"

namespace trackbed {

/// What the page of a study shows of the search whose runs `table`, read from `file`, has: its
/// outcome, for each key the margins and how much of its range was tried, and the best run so far.
/// Null when `file` is not in the folder of a search.
///
/// InputError naming the file when falsify.json or sweep.json is not as Trackbed writes it, or when
/// falsify.json is of other runs than the table.
nlohmann::ordered_json SearchData(const std::filesystem::path& file, const TextTable& table);

}  // namespace trackbed
