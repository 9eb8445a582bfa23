#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/options/key_visitor.h"

/// How to read a path from another program.
namespace trackbed {

enum class PathFormat {
  kAuto,  ///< Determined by file extension and first characters.
  /// A table with named columns. Racing lines of TUM have their header after '#'.
  kCsv,
  kNavPath,     ///< nav_msgs/Path of ROS as YAML or JSON.
  kCommonRoad,  ///< A solution of CommonRoad, XML.
  kGeoJson,     ///< A line string by RFC 7946.
};

/// The list of formats for users: "CSV, nav_msgs/Path (YAML, JSON), CommonRoad solution or
/// GeoJSON".
std::string PathFormatList();

/// The columns of a CSV file. Columns without a given name are found by their usual names
/// (PathColumnNames), ignoring case. By default, the suffix of a column's name determines its unit;
/// a column without a suffix has the SI unit.
struct PathColumns {
  std::optional<std::string> x;
  std::optional<std::string> y;
  std::optional<std::string> yaw;
  std::optional<std::string> curvature;
  std::optional<std::string> speed;
  std::optional<std::string> time;
  std::optional<std::string> position_unit;  ///< Unit of positions: "m", "cm", "mm" or "km".
  std::optional<std::string> yaw_unit;       ///< Unit of yaw: "rad" or "deg".
  std::optional<std::string> speed_unit;     ///< Unit of speeds: "m/s", "km/h" or "mph".
};
void Visit(KeyVisitor& keys, PathColumns& columns);

/// The meaning of the coordinates of a GeoJSON file.
enum class PathCoordinates {
  kAuto,    ///< WGS 84, or meters if the member `crs` names another reference system.
  kWgs84,   ///< Longitude and latitude in degrees.
  kMeters,  ///< x and y in meters, in any map projection.
};

struct PathMap {
  PathFormat format = PathFormat::kAuto;
  PathColumns columns;
  PathCoordinates coordinates = PathCoordinates::kAuto;
  /// Latitude of the origin in WGS 84 [deg]; default: the latitude of the first point.
  std::optional<double> origin_latitude;
  /// Longitude of the origin in WGS 84 [deg]; default: the longitude of the first point.
  std::optional<double> origin_longitude;
};
void Visit(KeyVisitor& keys, PathMap& map);

/// Problems that concern more than one key, as pairs of the key to change and the message.
std::vector<std::pair<std::string, std::string>> PathMapProblems(const PathMap& map);

/// A usual name of a column, and its unit.
struct PathColumnName {
  const char* name;
  const char* unit;
};

/// Returns the usual column names of a quantity ("x", "y", "yaw", "curvature", "speed" or "time"),
/// in order of preference.
const std::vector<PathColumnName>& PathColumnNames(std::string_view quantity);

}  // namespace trackbed
