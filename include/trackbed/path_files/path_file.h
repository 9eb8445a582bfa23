#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/path/fit_path.h"
#include "trackbed/path_files/path_map.h"

/// Reads paths planned by other programs, and the paths of trajectories.
namespace trackbed {

struct PathFile {
  PathPoints points;  ///< Points of the file, converted to SI units.
  /// Remarks on the file: the format, columns and units, the projection, and skipped parts.
  std::vector<std::string> notes;
};

/// The maximum number of points in a path file.
inline constexpr std::size_t kMaxPathPoints = 1'000'000;

/// Reads the path in a file; docs/how-to/check-a-path.md describes the formats.
///
/// If the file has times but no speeds, the speed of a point is the mean over the step to the next
/// point. The speed of the last point is the mean over the step before it.
///
/// ReadPathFile does not fit a curve, and does not check whether a car can follow the path.
///
/// Errors: InputError with file, line and column or key for every cell that is not a finite number
/// or is out of range (positions to 1e7 m, speeds from 0 to 100 m/s). InputError for missing
/// columns, with the nearest spelling, and for missing members. InputError for times that do not
/// increase, for fewer than two points, and for more than kMaxPathPoints points. InputError for
/// malformed text, text nested deeper than 64 levels, aliases in YAML, and coordinates that do not
/// exist on Earth. RunError if the file cannot be read or is larger than 512 MiB (formats other
/// than CSV: 16 MiB). Cost: about 1 us per point.
PathFile ReadPathFile(const std::filesystem::path& file, const PathMap& map = {});

/// Whether a YAML file in a folder of scenarios is a path and not a scenario. False if the file
/// cannot be read.
bool IsNavPathYaml(const std::filesystem::path& file);

/// The file name of a path in the run folder, next to the resolved scenario.
inline constexpr const char* kPathCsv = "path.csv";

/// Formats the points as a CSV file. ReadPathFile restores equal points from it, without a map.
std::string PathCsv(const PathPoints& points);

}  // namespace trackbed
