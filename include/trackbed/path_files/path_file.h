#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/path/fit_path.h"
#include "trackbed/path_files/drawn_lanes.h"
#include "trackbed/path_files/path_map.h"

/// Reads paths that other programs have planned. From a trajectory, reads the path, the speeds and
/// the times.
namespace trackbed {

struct PathFile {
  PathPoints points;  ///< Points in the file, converted to SI units.
  /// Remarks on how the file was read: format, columns and units, map projection, and skipped
  /// parts.
  std::vector<std::string> notes;
  /// Reasons why the speeds of the file cannot be driven, with their lines; if there is a reason,
  /// `points` has no speeds. A caller that needs the speeds should throw an InputError with the
  /// problems in `speed_problems`.
  std::vector<Problem> speed_problems;
  /// Lanes of a CommonRoad scenario or a Lanelet2 map within 150 m of the path.
  DrawnLanes lanes;
};

/// The maximum number of points in a path file.
inline constexpr std::size_t kMaxPathPoints = 1'000'000;

/// Reads the path in a file; docs/how-to/check-a-path.md describes the formats.
///
/// If the file has times but no speeds, the speed of each point is the mean speed between this
/// point and the next point. The speed of the last point is the mean speed between the last two
/// points.
///
/// A path with invalid speeds or times remains usable; PathFile::speed_problems lists the invalid
/// speeds and times. Speeds and times in a CSV file are invalid if they are not finite numbers or
/// out of range (speeds to 100 m/s), or if the times do not increase. Invalid curvatures are
/// dropped, with a note.
///
/// PathPoints::direction comes from a column of directions or gears, or from the signs of the
/// speeds. Speeds of less than 0.05 m/s, or of less than a tenth of the largest speed, have no
/// certain sign; points with these speeds have the direction 0. If a file has neither directions
/// nor negative speeds, PathPoints::direction is empty. For a CommonRoad solution with orientations
/// and velocities, PathPoints::direction is never empty, because velocities in CommonRoad are
/// signed.
///
/// Latitudes and longitudes are projected to meters (LocalPlane) about the first point or the
/// origin of the map; a note states the origin and the scale error. Points without a fix are
/// dropped, with a note (PositionsWithoutFix).
///
/// ReadPathFile does not fit a curve, and does not check whether a car can follow the path.
///
/// Throws InputError, with file, line and column or key, for every cell that is not a finite number
/// or is out of range (positions to 1e7 m). Invalid speeds, times and curvatures do not cause an
/// InputError. Throws InputError if a column is missing (the message suggests the most similar
/// name), or if a required member of a YAML or JSON file is missing. The direction of travel
/// decides whether the headings of a CSV file are measured from the x axis or from north, positive
/// to the left; a note says which. Throws InputError if the headings are degrees or compass
/// headings (the message suggests the unit). Also throws InputError if the column `psi_rad` of a
/// racing line fits the direction of travel neither if measured from the x axis nor if measured
/// from north. Also throws InputError if all headings of a CSV file are opposite to the direction
/// of travel although a column of speeds is not negative. Throws InputError if there are fewer than
/// two or more than kMaxPathPoints points. Throws InputError if the text of the path file is
/// malformed, is nested deeper than 64 levels, has YAML aliases, or contains coordinates that do
/// not exist on Earth. Throws RunError if the file cannot be read or is larger than 512 MiB (CSV)
/// or 16 MiB (other formats). Reading a path file takes about 1 us per point.
PathFile ReadPathFile(const std::filesystem::path& file, const PathMap& map = {});

/// Returns true if a YAML file in a folder of scenarios is a path and not a scenario. For a file
/// that cannot be read, returns false.
bool IsNavPathYaml(const std::filesystem::path& file);

/// Name of the file with the scenario's path in the run folder, next to the resolved scenario.
inline constexpr const char* kPathCsv = "path.csv";

/// Formats the points of a path as a CSV file. ReadPathFile reads equal points from this CSV file,
/// without further options.
std::string PathCsv(const PathPoints& points);

}  // namespace trackbed
