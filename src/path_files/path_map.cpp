#include "trackbed/path_files/path_map.h"

#include <fmt/format.h>

#include <map>
#include <string_view>
#include <tuple>
#include <utility>

#include "src/path_files/formats.h"
#include "trackbed/core/error.h"
#include "trackbed/path_files/globe.h"
#include "trackbed/path_files/globe_names.h"

// Keys of scenarios that describe how a path file is read, and the usual names of its columns.
// 1. Visit declares the keys with units, ranges and descriptions.
// 2. PathMapProblems checks conditions that involve several keys, such as a latitude without a
//    longitude.
// 3. PathColumnNames lists the names by which a CSV column is recognized, with the units.
namespace trackbed {

namespace {

EnumNames<PathFormat> FormatNames() {
  EnumNames<PathFormat> names{{PathFormat::kAuto, "auto"}};
  for (const PathFormatEntry& entry : PathFormats()) {
    names.emplace_back(entry.format, entry.name);
  }
  return names;
}

using Problems = std::vector<std::pair<std::string, std::string>>;

/// Refuses to read degrees as meters, and latitudes as longitudes.
void CheckGlobeColumns(const PathColumns& columns, Problems& problems) {
  if (columns.latitude.has_value() != columns.longitude.has_value()) {
    problems.emplace_back(columns.latitude ? "columns.longitude" : "columns.latitude",
                          "missing; give the columns of latitude and longitude or none");
  }
  if (columns.latitude && (columns.x || columns.y)) {
    problems.emplace_back(columns.x ? "columns.x" : "columns.y",
                          "not allowed with columns.latitude and columns.longitude");
  }
  const auto is_angle = [](const std::string& unit) { return unit == "deg" || unit == "rad"; };
  for (const auto& [key, name] :
       {std::pair("columns.x", &columns.x), std::pair("columns.y", &columns.y)}) {
    if (!*name) {
      continue;
    }
    if (NamesGlobeAxis(**name) || (columns.position_unit && is_angle(*columns.position_unit))) {
      problems.emplace_back(
          key,
          fmt::format("'{}' is in degrees, which are not meters: name it by columns.latitude "
                      "or columns.longitude{}",
                      **name,
                      NamesGlobeAxis(**name)
                          ? fmt::format("; if it is in meters, rename the column to {}_m", **name)
                          : ""));
    }
  }
  if (columns.latitude && columns.position_unit && !is_angle(*columns.position_unit)) {
    problems.emplace_back(
        "columns.position_unit",
        "'" + *columns.position_unit + "' is no unit of latitude and longitude; allowed: deg, rad");
  }
  for (const auto& [key, name, axis] :
       {std::tuple("columns.latitude", &columns.latitude, GlobeAxis::kLatitude),
        std::tuple("columns.longitude", &columns.longitude, GlobeAxis::kLongitude)}) {
    const std::optional<GlobeColumn> meaning = *name ? GlobeColumnOf(**name) : std::nullopt;
    if (meaning && meaning->axis != axis) {
      problems.emplace_back(
          key, fmt::format("'{}' is the other coordinate by its name: swap columns.latitude and "
                           "columns.longitude",
                           **name));
    }
  }
}

}  // namespace

std::string PathFormatList() {
  const std::vector<PathFormatEntry>& formats = PathFormats();
  std::string list;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    const char* separator = i == 0 ? "" : i + 1 == formats.size() ? " or " : ", ";
    list += std::string(separator) + formats[i].description;
  }
  return list;
}

void Visit(KeyVisitor& keys, PathColumns& columns) {
  keys.Field({"x", "", "column of the position; default: x_m, x or another usual name"}, columns.x);
  keys.Field({"y", "", "column of the position; default: y_m, y or another usual name"}, columns.y);
  keys.Field({"latitude", "",
              "column of the latitude (WGS 84); default: latitude, lat or the like, without x and "
              "y"},
             columns.latitude);
  keys.Field({"longitude", "",
              "column of the longitude (WGS 84); default: longitude, lon, lng or the like"},
             columns.longitude);
  keys.Field({"yaw", "",
              "column of the car's heading; default: yaw_rad, psi_rad, heading, ... if "
              "present"},
             columns.yaw);
  keys.Field(
      {"curvature", "", "column of the curvature; default: kappa_radpm, curvature, ... if present"},
      columns.curvature);
  keys.Field(
      {"speed", "",
       "column of the speed, negative in reverse; default: vx_mps, speed_mps, velocity, ... if "
       "present"},
      columns.speed);
  keys.Field({"time", "",
              "column of the time, from which speeds are computed if there are none; default: t_s, "
              "time, ..."},
             columns.time);
  keys.Field(
      {"direction", "",
       "column of the direction of motion or the gear, such as 1 and -1, D and R, or forward "
       "and reverse; default: direction, gear, ... if present"},
      columns.direction);
  keys.Field(
      {"position_unit", "",
       "m, cm, mm or km, deg or rad of latitude and longitude; default: that in the column's "
       "name, or m or deg"},
      columns.position_unit);
  keys.Field({"yaw_unit", "", "rad or deg; default: that in the column's name, or rad"},
             columns.yaw_unit);
  keys.Field({"speed_unit", "", "m/s, km/h or mph; default: that in the column's name, or m/s"},
             columns.speed_unit);
}

void Visit(KeyVisitor& keys, PathMap& map) {
  static const EnumNames<PathFormat> formats = FormatNames();
  static const std::string text =
      "of the file: " + PathFormatList() + "; auto: by its ending and content";
  keys.Field({"format", "", text.c_str()}, map.format, Need::kOptional, formats);
  keys.Section({"columns", "", "columns of a CSV file"}, map.columns);
  static const EnumNames<PathCoordinates> coordinates{{PathCoordinates::kAuto, "auto"},
                                                      {PathCoordinates::kWgs84, "wgs84"},
                                                      {PathCoordinates::kMeters, "meters"}};
  keys.Field({"coordinates", "",
              "of GeoJSON: longitude and latitude, or meters; auto: WGS 84 unless the file names "
              "another reference system"},
             map.coordinates, Need::kOptional, coordinates);
  keys.Field(
      {"origin_latitude", "deg", "origin of the projection of WGS 84; default: the first point"},
      map.origin_latitude, Range{.min = -89.0, .max = 89.0});
  keys.Field(
      {"origin_longitude", "deg", "origin of the projection of WGS 84; default: the first point"},
      map.origin_longitude, Range{.min = -180.0, .max = 180.0});
  keys.Field({"line", "",
              "which line of GPX, KML or GeoJSON, counted from 1; 0: the only line of the file"},
             map.line, Need::kOptional, Range{.min = 0, .max = 1e6});
  keys.Field({"topic", "",
              "topic of a bag; default: the only topic of nav_msgs/Path, whose first message is "
              "read; other topics: the position of each message"},
             map.topic);
  keys.Field(
      {"lanelets", "",
       "ids of the lanelets of a Lanelet2 map that the route visits, in this order: from the "
       "start of the first to the end of the last"},
      map.lanelets, Need::kOptional, {});
}

std::vector<std::pair<std::string, std::string>> PathMapProblems(const PathMap& map) {
  std::vector<std::pair<std::string, std::string>> problems;
  if (map.origin_latitude.has_value() != map.origin_longitude.has_value()) {
    problems.emplace_back(map.origin_latitude ? "origin_longitude" : "origin_latitude",
                          "missing; give both coordinates of the origin or none");
  }
  const auto check = [&](const char* key, const std::optional<std::string>& unit,
                         const std::vector<std::string>& allowed) {
    bool known = !unit;
    std::string list;
    for (const std::string& name : allowed) {
      known = known || *unit == name;
      list += (list.empty() ? "" : ", ") + name;
    }
    if (!known) {
      problems.emplace_back(std::string("columns.") + key,
                            "unknown unit '" + *unit + "'; allowed: " + list);
    }
  };
  CheckGlobeColumns(map.columns, problems);
  check("position_unit", map.columns.position_unit, {"m", "cm", "mm", "km", "deg", "rad"});
  check("yaw_unit", map.columns.yaw_unit, {"rad", "deg"});
  check("speed_unit", map.columns.speed_unit, {"m/s", "km/h", "mph"});
  return problems;
}

const std::vector<PathColumnName>& PathColumnNames(std::string_view quantity) {
  static const std::map<std::string_view, std::vector<PathColumnName>> names{
      {"x",
       {{"x_m", "m"},
        {"x", "m"},
        {"pos_x", "m"},
        {"position_x", "m"},
        {"x [m]", "m"},
        {"x_cm", "cm"},
        {"x_mm", "mm"},
        {"x_km", "km"},
        {"easting", "m"}}},
      {"y",
       {{"y_m", "m"},
        {"y", "m"},
        {"pos_y", "m"},
        {"position_y", "m"},
        {"y [m]", "m"},
        {"y_cm", "cm"},
        {"y_mm", "mm"},
        {"y_km", "km"},
        {"northing", "m"}}},
      {"yaw",
       {{"yaw_rad", "rad"},
        {"yaw", "rad"},
        {"heading_rad", "rad"},
        {"heading", "rad"},
        // In a file with a column psi, the column theta is the pitch angle.
        {"psi_rad", "rad"},
        {"psi", "rad"},
        {"theta_rad", "rad"},
        {"theta", "rad"},
        {"orientation", "rad"},
        {"yaw_deg", "deg"},
        {"heading_deg", "deg"},
        {"psi_deg", "deg"}}},
      {"curvature",
       {{"curvature_radpm", "1/m"},
        {"kappa_radpm", "1/m"},
        {"curvature", "1/m"},
        {"kappa", "1/m"},
        {"curvature_1pm", "1/m"}}},
      {"speed",
       {{"speed_mps", "m/s"},
        {"vx_mps", "m/s"},
        {"v_mps", "m/s"},
        {"speed", "m/s"},
        {"velocity", "m/s"},
        {"velocity_mps", "m/s"},
        {"v", "m/s"},
        {"vx", "m/s"},
        {"speed_kmh", "km/h"},
        {"v_kmh", "km/h"},
        {"speed_mph", "mph"}}},
      {"direction",
       {{"direction", "direction"},
        {"driving_direction", "direction"},
        {"motion_direction", "direction"},
        {"travel_direction", "direction"},
        {"dir", "direction"},
        {"gear", "gear"},
        {"gear_position", "gear"},
        {"forward", "forward"},
        {"is_forward", "forward"},
        {"reverse", "reverse"},
        {"is_reverse", "reverse"},
        {"backward", "reverse"}}},
      {"time", {{"t_s", "s"}, {"time_s", "s"}, {"time", "s"}, {"t", "s"}, {"timestamp", "s"}}},
  };
  const auto found = names.find(quantity);
  TRACKBED_CHECK(found != names.end(), "no quantity '{}'", quantity);
  return found->second;
}

}  // namespace trackbed
