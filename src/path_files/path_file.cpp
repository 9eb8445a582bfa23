#include "trackbed/path_files/path_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "src/path_files/formats.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/table.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTextBytes = std::size_t{16} << 20U;

/// Returns whether a .json file contains GeoJSON instead of a nav_msgs/Path.
bool HoldsGeoJson(const fs::path& file) {
  const nlohmann::json value = ParseJsonText(ReadFile(file, kMaxTextBytes), file.string());
  return value.is_object() && value.contains("type") && !value.contains("poses");
}

bool MayBeNavPath(const fs::path& file) {
  return LowerEnding(file) != ".json" || !HoldsGeoJson(file);
}

PathFile ReadAsNavPath(const fs::path& file, const PathMap& /*map*/) {
  const std::string text = ReadFile(file, kMaxTextBytes);
  const bool is_json = LowerEnding(file) == ".json";
  return ReadNavPath(
      file, is_json ? ParseJsonText(text, file.string()) : ParseYamlText(text, file.string()));
}

PathFile ReadAsGlobeXml(const fs::path& file, const PathMap& map) {
  GlobeFile lines = ReadGlobeXml(file, ReadFile(file, kMaxTextBytes));
  if (lines.lines.empty()) {
    RefuseNoLine(file, lines);
  }
  return PathOfGlobeFile(file, std::move(lines), map);
}

/// Returns the name of the root element of an XML file, without its namespace; "" if the first
/// block of the file has none.
std::string RootName(const fs::path& file) {
  std::string begin;
  ReadBlocks(file, [&](std::string_view block) {
    begin = block;
    return false;
  });
  std::string_view rest = begin;
  for (std::size_t at = rest.find('<'); at != std::string_view::npos; at = rest.find('<')) {
    rest.remove_prefix(at + 1);
    const bool is_comment = rest.starts_with("!--");
    if (!is_comment && !rest.starts_with('?') && !rest.starts_with('!')) {
      std::string_view name = rest.substr(0, rest.find_first_of(" \t\r\n/>"));
      name.remove_prefix(name.find(':') == std::string_view::npos ? 0 : name.find(':') + 1);
      return std::string(name);
    }
    const std::size_t end = rest.find(is_comment ? "-->" : ">");
    rest.remove_prefix(std::min(end, rest.size()));
  }
  return "";
}

/// Returns whether a file may be XML with one of the root elements. Checks the root element only if
/// the name of the file ends with .xml.
bool MayHaveRoot(const fs::path& file, std::initializer_list<const char*> roots) {
  return LowerEnding(file) != ".xml" ||
         std::find(roots.begin(), roots.end(), RootName(file)) != roots.end();
}

bool MayBeCommonRoad(const fs::path& file) {
  return LowerEnding(file) != ".xml" || !MayHaveRoot(file, {"gpx", "kml", "osm"});
}

bool MayBeGpx(const fs::path& file) {
  return MayHaveRoot(file, {"gpx"});
}

bool MayBeKml(const fs::path& file) {
  return MayHaveRoot(file, {"kml"});
}

bool MayBeLanelet2(const fs::path& file) {
  return MayHaveRoot(file, {"osm"});
}

/// Determines the format of a path file from the ending of its name and from its content. Returns
/// the first registered format if no format has this file name ending.
const PathFormatEntry& FormatOf(const fs::path& file) {
  const std::string ending = LowerEnding(file);
  for (const PathFormatEntry& entry : PathFormats()) {
    const bool has_ending =
        std::find(entry.endings.begin(), entry.endings.end(), ending) != entry.endings.end();
    if (has_ending && (entry.may_be == nullptr || entry.may_be(file))) {
      return entry;
    }
  }
  return PathFormats().front();
}

PathFile Read(const fs::path& file, const PathMap& map) {
  if (map.format == PathFormat::kAuto) {
    return FormatOf(file).read(file, map);
  }
  const std::vector<PathFormatEntry>& formats = PathFormats();
  const auto given =
      std::find_if(formats.begin(), formats.end(),
                   [&](const PathFormatEntry& entry) { return entry.format == map.format; });
  TRACKBED_CHECK(given != formats.end(), "no format {}", static_cast<int>(map.format));
  return given->read(file, map);
}

}  // namespace

const std::vector<PathFormatEntry>& PathFormats() {
  static const std::vector<PathFormatEntry> formats{
      {.format = PathFormat::kCsv, .name = "csv", .description = "CSV", .read = ReadPathCsv},
      {.format = PathFormat::kNavPath,
       .name = "nav_path",
       .description = "nav_msgs/Path (YAML, JSON)",
       .endings = {".yaml", ".yml", ".json"},
       .may_be = MayBeNavPath,
       .read = ReadAsNavPath},
      {.format = PathFormat::kCommonRoad,
       .name = "commonroad",
       .description = "CommonRoad solution",
       .endings = {".xml"},
       .may_be = MayBeCommonRoad,
       .read =
           [](const fs::path& file, const PathMap& /*map*/) {
             return ReadCommonRoad(file, ReadFile(file, kMaxTextBytes));
           }},
      {.format = PathFormat::kGeoJson,
       .name = "geojson",
       .description = "GeoJSON",
       .endings = {".geojson", ".json"},
       .read =
           [](const fs::path& file, const PathMap& map) {
             return ReadGeoJson(file, ParseJsonText(ReadFile(file, kMaxTextBytes), file.string()),
                                map);
           }},
      {.format = PathFormat::kGpx,
       .name = "gpx",
       .description = "GPX",
       .endings = {".gpx", ".xml"},
       .may_be = MayBeGpx,
       .read = ReadAsGlobeXml},
      {.format = PathFormat::kKml,
       .name = "kml",
       .description = "KML",
       .endings = {".kml", ".kmz", ".xml"},
       .may_be = MayBeKml,
       .read = ReadAsGlobeXml},
      {.format = PathFormat::kBag,
       .name = "rosbag2",
       .description = "rosbag2",
       .endings = {".mcap", ".db3", ".zstd"},
       .read = ReadPathBag},
      {.format = PathFormat::kLanelet2,
       .name = "lanelet2",
       .description = "Lanelet2",
       .endings = {".osm", ".xml"},
       .may_be = MayBeLanelet2,
       .read =
           [](const fs::path& file, const PathMap& map) {
             return ReadLanelet2(file, ReadFile(file, kMaxTextBytes), map);
           }},
  };
  return formats;
}

bool IsNavPathYaml(const fs::path& file) {
  try {
    const nlohmann::json root = ParseYamlText(ReadFile(file, kMaxTextBytes), file.string());
    const auto has_poses = [](const nlohmann::json& node) {
      return node.is_object() && node.contains("poses");
    };
    return has_poses(root) ||
           (root.is_object() && root.contains("path") && has_poses(root.at("path")));
  } catch (const InputError&) {
    return false;
  } catch (const RunError&) {
    return false;
  }
}

PathFile ReadPathFile(const fs::path& file, const PathMap& map) {
  std::vector<Problem> problems;
  for (auto& [key, message] : PathMapProblems(map)) {
    problems.push_back({.key = key, .message = std::move(message)});
  }
  if (!problems.empty()) {
    throw InputError(std::move(problems));
  }
  PathFile found = Read(file, map);
  const std::size_t count = found.points.points.size();
  if (count < 2) {
    Refuse(file, "",
           fmt::format("{} point{}; a path has at least 2", count, count == 1 ? "" : "s"));
  }
  // Where a line of the file has several points, messages give the numbers of points instead.
  std::vector<int>& lines = found.points.lines;
  if (std::adjacent_find(lines.begin(), lines.end()) != lines.end()) {
    lines.clear();
  }
  return found;
}

std::string PathCsv(const PathPoints& points) {
  std::vector<std::string> columns{"x_m", "y_m"};
  std::vector<const std::vector<double>*> lists;
  const auto add = [&](const char* name, const std::vector<double>& list) {
    if (!list.empty()) {
      columns.emplace_back(name);
      lists.push_back(&list);
    }
  };
  add("yaw_rad", points.yaw);
  add("curvature_radpm", points.curvature);
  add("speed_mps", points.speed);
  add("t_s", points.time);
  if (!points.direction.empty()) {
    columns.emplace_back("direction");
  }
  Table table(columns);
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    std::vector<double> row{points.points[i].x(), points.points[i].y()};
    for (const std::vector<double>* list : lists) {
      row.push_back((*list)[i]);
    }
    if (!points.direction.empty()) {
      row.push_back(points.direction[i]);
    }
    table.AddRow(row);
  }
  return table.ToCsv();
}

}  // namespace trackbed
