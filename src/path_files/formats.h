#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "trackbed/path_files/path_file.h"

namespace trackbed {

inline constexpr double kFarthest = 1e7;          ///< of a position from the origin [m]
inline constexpr double kFastest = 100.0;         ///< [m/s]
inline constexpr double kLargestCurvature = 1e6;  ///< [1/m]
inline constexpr int kDeepest = 64;               ///< levels of nesting

PathFile ReadPathCsv(const std::filesystem::path& file, const PathColumns& columns);
/// A nav_msgs/Path, or a message that has one as a member `path`.
PathFile ReadNavPath(const std::filesystem::path& file, const nlohmann::json& message);
PathFile ReadGeoJson(const std::filesystem::path& file, const nlohmann::json& json,
                     const PathMap& map);
PathFile ReadCommonRoad(const std::filesystem::path& file, const std::string& text);

/// The value that a JSON text is. InputError.
nlohmann::json ParseJsonText(const std::string& text, const std::string& file);
/// The value that the first document of a YAML text is, with numbers as they are in JSON; what
/// follows is passed by. InputError.
nlohmann::json ParseYamlText(const std::string& text, const std::string& file);

/// The number at `key`, finite and of at most `largest` size; else a problem.
double NumberOf(const nlohmann::json& value, const std::string& key, double largest,
                const std::string& file);

/// Speeds from times [s], which must rise: one problem otherwise, about "point N" at `key`.
void AddSpeeds(PathPoints& points, const std::vector<double>& times, const std::string& file);

[[noreturn]] void Refuse(const std::filesystem::path& file, const std::string& key,
                         std::string message, int line = 0);

}  // namespace trackbed
