#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/path_files/direction.h"
#include "src/path_files/globe_path.h"
#include "src/path_files/heading_unit.h"
#include "src/path_files/json.h"
#include "src/path_files/reading.h"
#include "trackbed/path_files/globe_file.h"
#include "trackbed/path_files/path_file.h"

namespace trackbed {

/// A format of path files.
struct PathFormatEntry {
  PathFormat format = PathFormat::kAuto;
  const char* name = "";         ///< Name of the format, as used in the key `format` of a scenario.
  const char* description = "";  ///< Text that describes the format to users.
  /// Endings of the names of files in this format, in lower case.
  std::vector<std::string> endings{};
  /// Function that returns whether the content of a file may have this format; null if any content
  /// may.
  bool (*may_be)(const std::filesystem::path& file) = nullptr;
  PathFile (*read)(const std::filesystem::path& file, const PathMap& map) = nullptr;
};

/// Returns the list of path formats. The first format is used for files whose ending belongs to no
/// format.
const std::vector<PathFormatEntry>& PathFormats();

PathFile ReadPathCsv(const std::filesystem::path& file, const PathMap& map);
/// Reads a ROS message nav_msgs/Path, or a message that contains a nav_msgs/Path as member `path`.
PathFile ReadNavPath(const std::filesystem::path& file, const nlohmann::json& message);
PathFile ReadGeoJson(const std::filesystem::path& file, const nlohmann::json& json,
                     const PathMap& map);
/// Reads a path from a bag of ROS 2: a message nav_msgs/Path, or the positions of the messages of a
/// topic.
PathFile ReadPathBag(const std::filesystem::path& file, const PathMap& map);
/// Reads GPX or KML.
GlobeFile ReadGlobeXml(const std::filesystem::path& file, const std::string& text);
/// Refuses a file of positions that contains no line. The message names the file's single points,
/// if any, and explains how to make a line of them.
[[noreturn]] void RefuseNoLine(const std::filesystem::path& file, const GlobeFile& found);
GlobeFile ReadGeoJsonLines(const std::filesystem::path& file, const nlohmann::json& root);

/// Reads the centers of the lanelets of a route on a Lanelet2 map, with their speed limits.
PathFile ReadLanelet2(const std::filesystem::path& file, const std::string& text,
                      const PathMap& map);
PathFile ReadCommonRoad(const std::filesystem::path& file, const std::string& text);

}  // namespace trackbed
