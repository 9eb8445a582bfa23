#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/path/fit_path.h"
#include "trackbed/path_files/path_map.h"

/// Reads paths that other programs planned, and trajectories of which the path is taken.
namespace trackbed {

struct PathFile {
  PathPoints points;  ///< as they are in the file, in SI units
  /// What was found, for people: the format, columns and units, the projection, what was passed by.
  std::vector<std::string> notes;
};

/// The most points of a file.
inline constexpr std::size_t kMostPathPoints = 1'000'000;

/// Reads the path in a file; docs/how-to/check-a-path.md has the formats.
///
/// Speeds that the file does not have, but times, are those from each point to the next, of the
/// last one those from the one before.
///
/// Does not fit a curve, nor look whether a car can follow.
///
/// Errors: InputError with file, line and column or key for every cell that is not a finite number
/// or out of range (positions to 1e7 m, speeds from 0 to 100 m/s), for missing columns, with the
/// nearest spelling, and members, for times that do not rise, for fewer than two points and more
/// than kMostPathPoints, for text that is not of its format or nested deeper than 64 levels, for
/// aliases in YAML and for coordinates that no place on Earth has. RunError when the file cannot be
/// read or is larger than 512 MiB, other formats than CSV than 16 MiB. Cost: about 1 us a point.
PathFile ReadPathFile(const std::filesystem::path& file, const PathMap& map = {});

/// Whether a file is a path as YAML: no scenario, though in a folder of them. False when it cannot
/// be read.
bool IsNavPathYaml(const std::filesystem::path& file);

/// The name of a path beside the resolved scenario of a run.
inline constexpr const char* kPathCsv = "path.csv";

/// The points as a CSV file that ReadPathFile reads back to equal ones without a map.
std::string PathCsv(const PathPoints& points);

}  // namespace trackbed
