#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

namespace trackbed {

/// Returns the file with the table of the study at `path`: `path` itself, or the table in the
/// folder of a sweep. Returns nullopt if `path` is not a study.
std::optional<std::filesystem::path> StudyTable(const std::filesystem::path& path);

/// Returns the data of a study and, if `before` is given, its differences from the study `before`.
/// Throws InputError if a table is not the table of a sweep. Throws the errors of StudyDifference.
nlohmann::ordered_json StudyData(const std::filesystem::path& table,
                                 const std::optional<std::filesystem::path>& before = {});

}  // namespace trackbed
