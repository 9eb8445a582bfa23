#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/path_files/path_file.h"

namespace trackbed {

/// Largest distance of a position from the origin [m].
inline constexpr double kMaxPosition = 1e7;
inline constexpr double kMaxPathSpeed = 100.0;    ///< Largest speed [m/s].
inline constexpr double kMaxPathCurvature = 1e6;  ///< Largest curvature [1/m].
inline constexpr int kMaxDepth = 64;              ///< Largest nesting depth.

/// A format of path files.
struct PathFormatEntry {
  PathFormat format = PathFormat::kAuto;
  const char* name = "";               ///< Value of the key `format`.
  const char* description = "";        ///< Description of the format for users.
  std::vector<std::string> endings{};  ///< Endings of file names, in lower case.
  /// Returns whether the content of a file fits the format. If null, any content fits.
  bool (*may_be)(const std::filesystem::path& file) = nullptr;
  PathFile (*read)(const std::filesystem::path& file, const PathMap& map) = nullptr;
};

/// Returns the list of path formats. Files with an ending that no format lists are read in the
/// first format.
const std::vector<PathFormatEntry>& PathFormats();

PathFile ReadPathCsv(const std::filesystem::path& file, const PathColumns& columns);
/// Reads a ROS message nav_msgs/Path, or a message that contains a nav_msgs/Path as member `path`.
PathFile ReadNavPath(const std::filesystem::path& file, const nlohmann::json& message);
PathFile ReadGeoJson(const std::filesystem::path& file, const nlohmann::json& json,
                     const PathMap& map);
PathFile ReadCommonRoad(const std::filesystem::path& file, const std::string& text);

/// Parses a JSON text. Throws InputError if the text is not valid JSON.
nlohmann::json ParseJsonText(const std::string& text, const std::string& file);
/// Parses the first document of a YAML text, with numbers as in JSON. Ignores all other documents.
/// Throws InputError if the text is not valid YAML.
nlohmann::json ParseYamlText(const std::string& text, const std::string& file);

/// Returns the number at `key`. Throws InputError unless the number is finite and its magnitude is
/// at most `largest`.
double NumberOf(const nlohmann::json& value, const std::string& key, double largest,
                const std::string& file);

/// Computes the speeds of points from their times [s]. Throws InputError that names the point if
/// the times do not increase.
void AddSpeeds(PathPoints& points, const std::vector<double>& times, const std::string& file);

[[noreturn]] void Refuse(const std::filesystem::path& file, const std::string& key,
                         std::string message, int line = 0);

}  // namespace trackbed
