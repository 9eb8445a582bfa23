#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "src/path_files/formats.h"
#include "trackbed/core/error.h"
#include "trackbed/core/timestamp.h"

// Reads line strings from GeoJSON (RFC 7946), alone, in features or in collections of features.
// Times are read from the members `coordTimes` or `coordinateProperties.times` of a feature, as
// converters of GPX files write them.
namespace trackbed {
namespace {

using nlohmann::json;

struct Found {
  const json* coordinates = nullptr;
  const json* times = nullptr;  // one timestamp for each position, or null
  std::string key;
};

std::string TypeOf(const json& value) {
  return value.is_object() && value.contains("type") && value["type"].is_string()
             ? value["type"].get<std::string>()
             : "";
}

/// Returns the list of times in the properties of a feature; null if the feature has no times.
const json* TimesOf(const json& feature) {
  if (!feature.contains("properties") || !feature["properties"].is_object()) {
    return nullptr;
  }
  const json& properties = feature["properties"];
  if (properties.contains("coordTimes")) {
    return &properties["coordTimes"];
  }
  if (properties.contains("coordinateProperties") &&
      properties["coordinateProperties"].is_object() &&
      properties["coordinateProperties"].contains("times")) {
    return &properties["coordinateProperties"]["times"];
  }
  return nullptr;
}

/// Counts the points in features and geometry collections that are no part of another geometry.
std::size_t SinglePoints(const json& value) {
  const std::string type = TypeOf(value);
  if (type == "Feature" && value.contains("geometry")) {
    return SinglePoints(value["geometry"]);
  }
  const char* list = type == "FeatureCollection"    ? "features"
                     : type == "GeometryCollection" ? "geometries"
                                                    : "coordinates";
  if (type == "Point" || !value.is_object() || !value.contains(list) || !value[list].is_array()) {
    return type == "Point" ? 1 : 0;
  }
  std::size_t count = type == "MultiPoint" ? value[list].size() : 0;
  for (const json& part : value[list]) {
    count += SinglePoints(part);
  }
  return count;
}

/// Collects all line strings in features and geometry collections, and ignores other geometries.
void FindLines(const json& value, const std::string& key, const json* times,
               std::vector<Found>& found) {
  const std::string type = TypeOf(value);
  const auto inside = [&](const char* name) {
    if (value.contains(name) && value[name].is_array()) {
      for (std::size_t i = 0; i < value[name].size(); ++i) {
        FindLines(value[name][i], fmt::format("{}{}[{}].", key, name, i), times, found);
      }
    }
  };
  if (type == "FeatureCollection") {
    inside("features");
  } else if (type == "GeometryCollection") {
    inside("geometries");
  } else if (type == "Feature" && value.contains("geometry")) {
    FindLines(value["geometry"], key + "geometry.", TimesOf(value), found);
  } else if (type == "LineString" && value.contains("coordinates")) {
    found.push_back({&value["coordinates"], times, key + "coordinates"});
  } else if (type == "MultiLineString" && value.contains("coordinates") &&
             value["coordinates"].is_array()) {
    const json& lines = value["coordinates"];
    const bool has_times = times != nullptr && times->is_array() && times->size() == lines.size();
    for (std::size_t i = 0; i < lines.size(); ++i) {
      found.push_back({&lines[i], has_times ? &(*times)[i] : nullptr,
                       fmt::format("{}coordinates[{}]", key, i)});
    }
  }
}

/// Returns the name of the coordinate reference system, which GeoJSON 2008 specifies in the member
/// `crs`. Returns nullopt if the file has no member `crs` with a name.
std::optional<std::string> NamedSystem(const json& root) {
  if (root.contains("crs") && root["crs"].is_object() && root["crs"].contains("properties") &&
      root["crs"]["properties"].is_object() && root["crs"]["properties"].contains("name") &&
      root["crs"]["properties"]["name"].is_string()) {
    return root["crs"]["properties"]["name"].get<std::string>();
  }
  return std::nullopt;
}

bool IsWgs84(const std::string& system) {
  return system.find("CRS84") != std::string::npos || system.ends_with("4326");
}

/// Returns the first two numbers of each position, and the third number, the height, if any.
std::vector<std::pair<Vec2, std::optional<double>>> Positions(const Found& found,
                                                              const std::string& file) {
  const json& list = *found.coordinates;
  if (!list.is_array()) {
    Refuse(file, found.key, "must be a list of positions");
  }
  std::vector<std::pair<Vec2, std::optional<double>>> positions;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string key = fmt::format("{}[{}]", found.key, i);
    if (!list[i].is_array() || list[i].size() < 2 || list[i].size() > 4) {
      Refuse(file, key, "must be a position of two or three numbers");
    }
    const Vec2 position(NumberOf(list[i][0], key + "[0]", kMaxPosition, file),
                        NumberOf(list[i][1], key + "[1]", kMaxPosition, file));
    positions.emplace_back(position, list[i].size() > 2 && list[i][2].is_number()
                                         ? std::optional(list[i][2].get<double>())
                                         : std::nullopt);
  }
  return positions;
}

std::optional<double> TimeOf(const json* times, std::size_t i) {
  return times != nullptr && times->is_array() && i < times->size() && (*times)[i].is_string()
             ? TimestampSeconds((*times)[i].get_ref<const std::string&>())
             : std::nullopt;
}

GlobeLine LineOf(const Found& found, const std::string& file) {
  GlobeLine line{.name = found.key, .track = 0, .points = {}};
  for (const auto& [position, height] : Positions(found, file)) {
    const GlobePosition at{.latitude = position.y(), .longitude = position.x()};
    if (const std::string problem = GlobeProblem(at); !problem.empty()) {
      Refuse(file, fmt::format("{}[{}]", found.key, line.points.size()),
             problem +
                 "; GeoJSON has the longitude first; if these are meters, say coordinates: "
                 "meters");
    }
    const std::optional<double> time = TimeOf(found.times, line.points.size());
    line.points.push_back({.position = at, .time = time, .height = height});
  }
  return line;
}

std::vector<Found> LinesOf(const json& root) {
  std::vector<Found> lines;
  FindLines(root, "", nullptr, lines);
  return lines;
}

}  // namespace

GlobeFile ReadGeoJsonLines(const std::filesystem::path& file, const json& root) {
  GlobeFile found{.format = "GeoJSON", .lines = {}, .single_points = SinglePoints(root)};
  const std::optional<std::string> system = NamedSystem(root);
  if (system && !IsWgs84(*system)) {
    Refuse(file, "crs",
           fmt::format("{} is not WGS 84; convert the file (ogr2ogr -t_srs EPSG:4326)", *system));
  }
  for (const Found& line : LinesOf(root)) {
    found.lines.push_back(LineOf(line, file.string()));
    found.lines.back().track = found.lines.size();
    if (found.lines.back().points.empty()) {
      found.lines.pop_back();
    }
  }
  return found;
}

PathFile ReadGeoJson(const std::filesystem::path& path, const json& root, const PathMap& map) {
  const std::string file = path.string();
  const std::vector<Found> lines = LinesOf(root);
  const std::optional<std::string> system = NamedSystem(root);
  const bool in_degrees =
      map.coordinates == PathCoordinates::kWgs84 ||
      (map.coordinates == PathCoordinates::kAuto && (!system || IsWgs84(*system)));
  if (lines.empty()) {
    RefuseNoLine(path, {.format = "GeoJSON", .lines = {}, .single_points = SinglePoints(root)});
  }
  const std::size_t wanted = map.line == 0 ? 1 : static_cast<std::size_t>(map.line);
  if (!in_degrees && (wanted > lines.size() || (map.line == 0 && lines.size() > 1))) {
    Refuse(file, "",
           fmt::format("{} line strings; must be one{}", lines.size(),
                       lines.size() > 1
                           ? fmt::format(", or select one by line: 1 to line: {}", lines.size())
                           : std::string()));
  }
  if (in_degrees) {
    GlobeFile found{.format = "GeoJSON", .lines = {}, .single_points = 0};
    for (const Found& line : lines) {
      found.lines.push_back(LineOf(line, file));
      found.lines.back().track = found.lines.size();
      if (found.lines.back().points.empty()) {
        found.lines.pop_back();
      }
    }
    if (found.lines.empty()) {
      Refuse(file, lines.front().key, "has no positions");
    }
    return PathOfGlobeFile(path, std::move(found), map);
  }
  PathFile found;
  for (const auto& [position, height] : Positions(lines[wanted - 1], file)) {
    found.points.points.push_back(position);
  }
  if (found.points.points.empty()) {
    Refuse(file, lines[wanted - 1].key, "has no positions");
  }
  found.notes.push_back("GeoJSON, meters" + (system ? " of " + *system : std::string()));
  return found;
}

}  // namespace trackbed
