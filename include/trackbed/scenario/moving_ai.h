#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Problem instances of the Moving AI benchmarks (Sturtevant 2012).
namespace trackbed {

/// A path search between two cells. Columns and rows count as in a GridMap: the first row is at the
/// bottom, whereas the file counts rows from the top.
struct MovingAiInstance {
  int line = 0;     ///< Line in the file.
  int bucket = 0;   ///< Number of the group of instances with paths of similar length.
  std::string map;  ///< Name of the map file.
  int columns = 0;  ///< Number of columns of the map.
  int rows = 0;
  int start_column = 0;
  int start_row = 0;
  int goal_column = 0;
  int goal_row = 0;
  /// Length of the shortest path, as stated in the file [cells]. Steps have the length 1. Diagonal
  /// steps have the length sqrt(2) and require that both adjacent cells are free.
  double length = 0.0;
};

/// Reads a `.scen` file of version 1. InputError lists the line of every problem: a different
/// version, too few or too many fields, an invalid number, or a cell outside of the map.
std::vector<MovingAiInstance> ReadMovingAiInstances(const std::filesystem::path& file);

}  // namespace trackbed
