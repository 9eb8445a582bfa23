#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/path_files/direction.h"
#include "trackbed/path_files/path_file.h"

namespace trackbed {

/// Column of the table from which a quantity is read.
struct PathColumn {
  std::size_t index;
  double factor;  ///< Factor that converts the column's values to SI units.
  double offset = 0.0;
  double largest = 0.0;  ///< Largest permitted magnitude of the quantity, in SI units.
};

/// Quantities of a path. A path can be read even if the columns of the quantities from kCurvature
/// on are unusable.
enum PathQuantity { kX, kY, kYaw, kCurvature, kSpeed, kTime, kMotion, kQuantities };

/// The columns of a CSV table that hold the quantities of a path.
struct CsvLayout {
  std::vector<std::string> names;  ///< Names of all columns, in the order of the file.
  std::array<std::optional<PathColumn>, kQuantities> columns;
  /// Columns of the local origin, x and y.
  std::array<std::optional<std::size_t>, 2> origin;
  DirectionColumn direction = DirectionColumn::kSigned;
  bool is_globe = false;  ///< Whether kX and kY are longitudes and latitudes [deg].
  bool is_unnamed =
      false;  ///< Whether the file has no column names, and the caller names no columns.
  /// Problems of the header, each with the name of its column. If the header has problems, the
  /// table has no valid layout.
  std::vector<std::pair<std::string, std::string>> problems;

  /// Returns the names of the columns that are read.
  [[nodiscard]] std::vector<std::string> Used() const;
};

/// Finds the columns by the names that the caller specifies, or by their usual names.
CsvLayout FindCsvLayout(std::vector<std::string> names, const PathColumns& requested);

}  // namespace trackbed
