#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

namespace trackbed {

/// The table of a study that `path` is or, as the folder of a sweep, has. None: it is no study.
std::optional<std::filesystem::path> StudyTable(const std::filesystem::path& path);

/// What the page shows of a study, and how it differs from the study `before`. InputError when a
/// table is not a sweep's, and as StudyDifference.
nlohmann::ordered_json StudyData(const std::filesystem::path& table,
                                 const std::optional<std::filesystem::path>& before = {});

}  // namespace trackbed
