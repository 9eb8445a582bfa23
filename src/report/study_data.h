#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

namespace trackbed {

/// Returns the file with the table of a study: `path` itself or, if `path` is the folder of a
/// sweep, the table in this folder. Returns nullopt if `path` is neither a study table nor the
/// folder of a study.
std::optional<std::filesystem::path> StudyTable(const std::filesystem::path& path);

/// Returns the data of a study and, if `before` is given, its differences from the study `before`.
/// Throws InputError if a file is not the table of a sweep. If `before` is given, also throws the
/// errors of StudyDifference.
nlohmann::ordered_json StudyData(const std::filesystem::path& table,
                                 const std::optional<std::filesystem::path>& before = {});

}  // namespace trackbed
