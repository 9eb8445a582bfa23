#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Recognizes CSV files that are not a list of path points with a header of column names.
namespace trackbed {

/// Returns whether the names of the columns are numbers (CsvLimits::numbers_columns).
bool AreNumbered(const std::vector<std::string>& names);

/// Returns the index of the first cell that names the color of a cone beside a track of Formula
/// Student, such as big_orange. If no cell names a cone's color, the result is the number of cells.
std::size_t ConeCell(const std::vector<std::string>& row);

/// Explains that a table lists cones instead of points of a path.
std::string ConesInsteadOfPath();

/// Explains which numbers to give for the columns of a file without names, by the cells of its
/// first row.
std::string UnnamedColumns(const std::vector<std::string>& row);

}  // namespace trackbed
