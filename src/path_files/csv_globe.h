#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/path_files/globe.h"
#include "trackbed/path_files/path_file.h"

namespace trackbed {

/// Columns of latitude and longitude in a CSV file; both or none are set.
struct CsvGlobe {
  std::optional<std::size_t> latitude;
  std::optional<std::size_t> longitude;
  double latitude_unit = 1.0;   ///< Value of one unit of the column [deg].
  double longitude_unit = 1.0;  ///< Value of one unit of the column [deg].
  /// Names of columns that the file lacks, each with a message.
  std::vector<std::pair<std::string, std::string>> problems;
};

/// Finds the columns of latitude and longitude that `requested` names or, if the file has no
/// columns of x and y (`has_plane` is false), that have a usual name.
CsvGlobe FindCsvGlobe(const std::vector<std::string>& names, const PathColumns& requested,
                      bool has_plane);

/// Returns the problems of a row, by column: a position that does not exist, or a positive number
/// although another column has a letter for south or west.
std::vector<std::pair<std::string, std::string>> CsvGlobeProblems(
    const GlobePosition& position, const std::vector<std::string>& names,
    const std::vector<std::string>& cells);

/// Projects the points of a path, which are longitudes and latitudes [deg], to meters. Drops the
/// points without a fix, and their times.
void ProjectCsv(PathFile& path, std::vector<double>& times,
                const std::optional<GlobePosition>& origin, const std::filesystem::path& file);

}  // namespace trackbed
