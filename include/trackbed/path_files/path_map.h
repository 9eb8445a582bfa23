#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/options/key_visitor.h"

/// How to read the path file of another program.
namespace trackbed {

enum class PathFormat {
  kAuto,  ///< The file extension and the first characters of the file determine the format.
  /// A CSV table with named columns. In racing lines from TUM, the line with the column names
  /// begins with '#'.
  kCsv,
  kNavPath,     ///< A ROS message of the type nav_msgs/Path, as YAML or JSON.
  kCommonRoad,  ///< A solution of CommonRoad, or the route of a CommonRoad scenario (XML).
  kGeoJson,     ///< A GeoJSON line string according to RFC 7946.
  kGpx,         ///< A track or route of GPX 1.0 or 1.1.
  kBag,         ///< A message nav_msgs/Path in a bag of ROS 2 (MCAP, SQLite).
  kKml,         ///< A LineString or gx:Track of KML 2.2 or 2.3.
  kLanelet2,    ///< A route along the lanelets of a Lanelet2 map (OSM XML).
};

/// Returns the list of formats as text for users: "CSV, nav_msgs/Path (YAML, JSON), CommonRoad
/// solution, GeoJSON, GPX, KML, rosbag2 or Lanelet2".
std::string PathFormatList();

/// The names of the columns of a CSV file. If the name of a column is not set, the reader looks for
/// the usual names of the quantity (PathColumnNames), ignoring case. By default, the suffix of a
/// column's name determines the unit of the column; a column whose name has no suffix is in SI
/// units.
struct PathColumns {
  std::optional<std::string> x;
  std::optional<std::string> y;
  /// Column of the latitude in WGS 84. Without columns of x and y, the reader also recognizes
  /// columns of latitude and longitude by their names (GlobeColumnOf).
  std::optional<std::string> latitude;
  std::optional<std::string> longitude;  ///< Column of the longitude in WGS 84.
  std::optional<std::string> yaw;
  std::optional<std::string> curvature;
  std::optional<std::string> speed;
  std::optional<std::string> time;
  std::optional<std::string> direction;  ///< Column of the direction of motion, or of the gear.
  /// Unit of the position columns: "m", "cm", "mm" or "km"; "deg" or "rad" for latitude and
  /// longitude.
  std::optional<std::string> position_unit;
  std::optional<std::string> yaw_unit;    ///< Unit of the yaw column: "rad" or "deg".
  std::optional<std::string> speed_unit;  ///< Unit of the speed column: "m/s", "km/h" or "mph".
};
void Visit(KeyVisitor& keys, PathColumns& columns);

/// The type of coordinates in a GeoJSON file.
enum class PathCoordinates {
  /// The file's coordinates are in WGS 84, or in meters if its member `crs` names another reference
  /// system.
  kAuto,
  kWgs84,   ///< The file's coordinates are longitude and latitude in degrees.
  kMeters,  ///< The file's coordinates are x and y in meters, in any map projection.
};

struct PathMap {
  PathFormat format = PathFormat::kAuto;
  PathColumns columns;
  PathCoordinates coordinates = PathCoordinates::kAuto;
  /// Latitude in WGS 84 of the path's coordinate origin [deg]; default: the latitude of the first
  /// point.
  std::optional<double> origin_latitude;
  /// Longitude in WGS 84 of the path's coordinate origin [deg]; default: the longitude of the first
  /// point.
  std::optional<double> origin_longitude;
  /// Number of the line in a GPX, KML or GeoJSON file with several tracks, routes or line strings,
  /// counted from 1; 0: the only line.
  int line = 0;
  /// Topic of a bag; default: the only topic of the type nav_msgs/Path.
  std::optional<std::string> topic;
  /// Ids of the lanelets of a Lanelet2 map that the route visits, in the order of the route.
  std::vector<std::string> lanelets;
};
void Visit(KeyVisitor& keys, PathMap& map);

/// Returns the problems that concern several keys of `map` together. Each returned pair contains
/// the key that the user should change and the error message.
std::vector<std::pair<std::string, std::string>> PathMapProblems(const PathMap& map);

/// A usual name of a column, and the unit that this name implies.
struct PathColumnName {
  const char* name;
  const char* unit;
};

/// Returns the usual column names of a quantity ("x", "y", "yaw", "curvature", "speed", "time" or
/// "direction"), in order of preference. The unit of a column of directions is "direction", "gear",
/// "forward" or "reverse", and states the meaning of the numbers in the column.
const std::vector<PathColumnName>& PathColumnNames(std::string_view quantity);

}  // namespace trackbed
