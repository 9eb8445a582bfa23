#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/path/fit_path.h"
#include "trackbed/path_files/path_map.h"

/// Reads paths that other programs planned, and the paths of their trajectories.
namespace trackbed {

struct PathFile {
  PathPoints points;  ///< as in the file, converted to SI units
  /// Remarks on the file: the format, columns and units, the projection, and what was skipped.
  std::vector<std::string> notes;
};

/// The maximum number of points of a file.
inline constexpr std::size_t kMaxPathPoints = 1'000'000;

/// Reads the path in a file; docs/how-to/check-a-path.md describes the formats.
///
/// If the file has times but no speeds, a point's speed is the mean over the step to the next
/// point, and that of the last point the mean over the step before it.
///
/// Does not fit a curve, nor check whether a car can follow.
///
/// Errors: InputError with file, line and column or key for every cell that is not a finite number
/// or out of range (positions to 1e7 m, speeds from 0 to 100 m/s); for missing columns, with the
/// nearest spelling, and missing members; for times that do not rise; for fewer than two points and
/// more than kMaxPathPoints; for text that is malformed or nested deeper than 64 levels; for
/// aliases in YAML; and for coordinates that do not exist on Earth. RunError when the file cannot
/// be read or is larger than 512 MiB (formats other than CSV: 16 MiB). Cost: about 1 us per point.
PathFile ReadPathFile(const std::filesystem::path& file, const PathMap& map = {});

/// Whether a YAML file in a folder of scenarios is a path rather than a scenario. False when it
/// cannot be read.
bool IsNavPathYaml(const std::filesystem::path& file);

/// The file name of a path beside the resolved scenario of a run.
inline constexpr const char* kPathCsv = "path.csv";

/// The points as a CSV file that ReadPathFile reads back to equal points without a map.
std::string PathCsv(const PathPoints& points);

}  // namespace trackbed
