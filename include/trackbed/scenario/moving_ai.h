#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// The problem instances of the Moving AI benchmarks for their maps (Sturtevant 2012).
namespace trackbed {

/// A path search between two cells, in columns and rows of a GridMap: the first row is at the
/// bottom, while the file counts from the top.
struct MovingAiInstance {
  int line = 0;     ///< in the file
  int bucket = 0;   ///< the file's group of instances of similar length
  std::string map;  ///< the name of its file
  int columns = 0;  ///< of the map
  int rows = 0;
  int start_column = 0;
  int start_row = 0;
  int goal_column = 0;
  int goal_row = 0;
  /// Length of the shortest path as listed [cells]: steps of 1, and of sqrt(2) if both adjacent
  /// cells are free.
  double length = 0.0;
};

/// Reads a `.scen` file of version 1. InputError with the line of every problem: another version,
/// too few or too many fields, an invalid number, a cell outside of the map.
std::vector<MovingAiInstance> ReadMovingAiInstances(const std::filesystem::path& file);

}  // namespace trackbed
