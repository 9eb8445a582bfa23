#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/path_files/globe_file.h"
#include "trackbed/path_files/path_file.h"

namespace trackbed {

/// Largest magnitude of a path point's x and y coordinates [m].
inline constexpr double kMaxPosition = 1e7;
inline constexpr double kMaxPathSpeed = 100.0;    ///< Largest speed [m/s].
inline constexpr double kMaxPathCurvature = 1e6;  ///< Largest curvature [1/m].
inline constexpr int kMaxDepth = 64;              ///< Largest nesting depth.
/// Largest size of a GPX, KML or GeoJSON file that is read as a recording [bytes].
inline constexpr std::size_t kMaxGlobeBytes = std::size_t{64} << 20U;

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
GlobeFile ReadGeoJsonLines(const std::filesystem::path& file, const nlohmann::json& root);
/// Returns the path along one line of the file: the only line, or the line PathMap::line.
PathFile PathOfGlobeFile(const std::filesystem::path& file, GlobeFile lines, const PathMap& map);
/// Returns the origin that the map specifies for the projection, if any.
std::optional<GlobePosition> OriginOf(const PathMap& map);
/// Reads the centers of the lanelets of a route on a Lanelet2 map, with their speed limits.
PathFile ReadLanelet2(const std::filesystem::path& file, const std::string& text,
                      const PathMap& map);
PathFile ReadCommonRoad(const std::filesystem::path& file, const std::string& text);

/// Returns the ending of a file's name in lower case, such as ".gpx".
std::string LowerEnding(const std::filesystem::path& file);

/// Parses a JSON text. Throws InputError if the text is not valid JSON.
nlohmann::json ParseJsonText(const std::string& text, const std::string& file);
/// Parses the first document of a YAML text, with numbers as in JSON. ParseYamlText ignores further
/// documents in the text. Throws InputError if the text is not valid YAML.
nlohmann::json ParseYamlText(const std::string& text, const std::string& file);

/// Returns the number that a JSON object contains at `key`. Throws InputError unless the number is
/// finite and its magnitude is at most `largest`.
double NumberOf(const nlohmann::json& value, const std::string& key, double largest,
                const std::string& file);

/// Stores the times at which the points are reached, from 0 [s]. If the points have no speeds,
/// computes the speed at each point from the times. If the times do not increase, or if a computed
/// speed is out of range, drops the speeds and the times and adds a problem that names the point to
/// PathFile::speed_problems.
void TakeTimes(PathFile& found, std::vector<double> times, const std::string& file);

/// Takes the stamps of ROS messages [s], one for each point, as TakeTimes does. Ignores stamps that
/// are all equal, as those of a planner that does not set them.
void TakeStamps(PathFile& found, std::vector<double> stamps, const std::string& file);

/// The meaning of the numbers in a column of directions of motion. In each, words such as "D", "R",
/// "forward" and "reverse" are allowed, too.
enum class DirectionColumn {
  kSigned,   ///< 1 forwards, -1 in reverse, 0 if the car stands.
  kGear,     ///< Positive forwards, negative in reverse, 0 neutral.
  kForward,  ///< 1 or true forwards, 0 or false in reverse.
  kReverse,  ///< 1 or true in reverse, 0 or false forwards.
};

/// Returns the direction of motion in a cell: 1, -1 or, if the car stands, 0. Returns nullopt if
/// the cell does not contain a direction.
std::optional<int> DirectionIn(const std::string& cell, DirectionColumn column);

/// Converts speeds that are negative in reverse to directions of motion and speeds of at least 0.
/// Keeps given directions other than 0.
void TakeSignedSpeeds(PathPoints& points);

/// Returns the problem, with its remedy, if the headings of points without directions of motion are
/// opposite to the direction of travel all along the path; else "". Such headings contradict a
/// column of speeds that are not negative.
std::string HalfTurnProblem(const PathPoints& points);

/// How a column of headings is read.
struct HeadingReading {
  double offset = 0.0;  ///< Angle to add to the headings [rad]: 0, or pi/2 for angles from north.
  std::string note;     ///< Text that states the meaning, without the column's name; may be empty.
  std::string problem;  ///< Why the headings are refused, for people; empty if they are read.
};

/// Decides from the direction of travel whether headings are measured from the x axis or from
/// north. The headings of `points` are in radians, positive to the left. If the headings fit
/// neither meaning but are degrees or compass headings, HeadingReading::problem states the remedy.
/// If they fit no common meaning, they are a problem in a racing line (`is_racing_line`); in other
/// files, they are read as measured from the x axis.
///
/// If `is_unit_known` is false, the numbers may be degrees.
HeadingReading ReadHeadings(const PathPoints& points, bool is_racing_line, bool is_unit_known);

[[noreturn]] void Refuse(const std::filesystem::path& file, const std::string& key,
                         std::string message, int line = 0);

}  // namespace trackbed
