#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

namespace trackbed {

/// The table of a study that `path` is or, as the folder of a sweep, has. None: it is no study.
std::optional<std::filesystem::path> StudyTable(const std::filesystem::path& path);

/// What the page shows of a study. InputError when the table is not a sweep's.
nlohmann::ordered_json StudyData(const std::filesystem::path& table);

}  // namespace trackbed
