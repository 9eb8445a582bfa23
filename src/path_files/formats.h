#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/path_files/path_file.h"

namespace trackbed {

inline constexpr double kMaxPosition = 1e7;       ///< distance of a position from the origin [m]
inline constexpr double kMaxPathSpeed = 100.0;    ///< [m/s]
inline constexpr double kMaxPathCurvature = 1e6;  ///< [1/m]
inline constexpr int kMaxDepth = 64;              ///< largest nesting depth

/// A format of path files.
struct PathFormatEntry {
  PathFormat format = PathFormat::kAuto;
  const char* name = "";                                        ///< value of the key `format`
  const char* description = "";                                 ///< for users
  std::vector<std::string> endings{};                           ///< of files, in lower case
  bool (*may_be)(const std::filesystem::path& file) = nullptr;  ///< by its content; null: yes
  PathFile (*read)(const std::filesystem::path& file, const PathMap& map) = nullptr;
};

/// The table of formats, one entry each. Files with an ending that is not listed have the first.
const std::vector<PathFormatEntry>& PathFormats();

PathFile ReadPathCsv(const std::filesystem::path& file, const PathColumns& columns);
/// Reads a nav_msgs/Path, or a message with a nav_msgs/Path as member `path`.
PathFile ReadNavPath(const std::filesystem::path& file, const nlohmann::json& message);
PathFile ReadGeoJson(const std::filesystem::path& file, const nlohmann::json& json,
                     const PathMap& map);
PathFile ReadCommonRoad(const std::filesystem::path& file, const std::string& text);

/// Parses a JSON text. InputError.
nlohmann::json ParseJsonText(const std::string& text, const std::string& file);
/// Parses the first document of a YAML text, with numbers as in JSON; ignores the rest. InputError.
nlohmann::json ParseYamlText(const std::string& text, const std::string& file);

/// The number at `key`, finite and at most `largest` in magnitude; otherwise InputError.
double NumberOf(const nlohmann::json& value, const std::string& key, double largest,
                const std::string& file);

/// Computes speeds from times [s]. InputError unless the times increase, about "point N" at `key`.
void AddSpeeds(PathPoints& points, const std::vector<double>& times, const std::string& file);

[[noreturn]] void Refuse(const std::filesystem::path& file, const std::string& key,
                         std::string message, int line = 0);

}  // namespace trackbed
