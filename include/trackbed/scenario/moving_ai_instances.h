#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Reads the path-planning problems of the Moving AI benchmarks (Sturtevant 2012), for programs
/// that compare a planner with the listed lengths, such as scripts/movingai (docs/how-to/maps.md).
namespace trackbed {

/// A path-planning problem: find a path between two cells of a map. As in a GridMap, rows are
/// counted from the bottom of the map, whereas the file counts rows from the top.
struct MovingAiInstance {
  int line = 0;     ///< Line number of the problem in the file.
  int bucket = 0;   ///< Number of the group ("bucket") of problems with paths of similar length.
  std::string map;  ///< Name of the file with the map of the problem.
  int columns = 0;  ///< Number of columns of the map.
  int rows = 0;
  int start_column = 0;
  int start_row = 0;
  int goal_column = 0;
  int goal_row = 0;
  /// Length of the shortest path, as stated in the file [cells]. Horizontal and vertical steps have
  /// the length 1. Diagonal steps have the length sqrt(2), and are only allowed if both cells next
  /// to the diagonal are free.
  double length = 0.0;
};

/// Reads a `.scen` file of version 1. Throws InputError, which lists the line of every problem: a
/// different version, too few or too many fields in a line, an invalid number, or a cell outside of
/// the map.
std::vector<MovingAiInstance> ReadMovingAiInstances(const std::filesystem::path& file);

}  // namespace trackbed
