#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/path_files/globe.h"

/// Reads lines of latitude and longitude from GPX, KML and GeoJSON files, as paths and as
/// recordings.
namespace trackbed {

struct GlobePoint {
  GlobePosition position;
  std::optional<double> time;    ///< Time since 1970-01-01T00:00:00Z [s].
  std::optional<double> height;  ///< Height as in the file [m].
  int line = 0;                  ///< Line number in the file; 0 if unknown.
};

/// A line in a file: a route, a segment of a track, a line string.
struct GlobeLine {
  std::string name;  ///< Description for people, such as "track 1 (Ride), segment 2".
  /// Lines of the same track, in the order of driving, have the same number.
  std::size_t track = 0;
  std::vector<GlobePoint> points;
};

struct GlobeFile {
  std::string format;            ///< "GPX", "KML" or "GeoJSON".
  std::vector<GlobeLine> lines;  ///< Lines of the file with at least one point.
  /// Points of the file that belong to no line, such as waypoints and markers.
  std::size_t single_points = 0;
};

/// Returns whether a file is GPX, KML, KMZ or GeoJSON by the ending of its name. A name that ends
/// with .json does not count as GeoJSON.
bool IsGlobeFile(const std::filesystem::path& file);

/// Reads a GPX, KML or GeoJSON file of at most 64 MiB and kMaxPathPoints points, with XML nested at
/// most 64 levels deep.
///
/// Throws InputError, with file and line, if the text is malformed, if the file has no line, or if
/// the file is a KMZ archive. Also throws InputError if a position does not exist (GlobeProblem) or
/// is not a number (NumberProblem). Throws RunError in the same cases as ReadFile.
GlobeFile ReadGlobeFile(const std::filesystem::path& file);

}  // namespace trackbed
