#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

namespace trackbed {

/// The table of the study at `path`: the file itself, or the table in a sweep's folder. StudyTable
/// returns none if `path` is no study.
std::optional<std::filesystem::path> StudyTable(const std::filesystem::path& path);

/// Data of a study, and its differences from the study `before`. Throws InputError if a table is
/// not that of a sweep. Throws the errors of StudyDifference.
nlohmann::ordered_json StudyData(const std::filesystem::path& table,
                                 const std::optional<std::filesystem::path>& before = {});

}  // namespace trackbed
