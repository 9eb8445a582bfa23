#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// The instances that the Moving AI benchmarks give to their maps (Sturtevant 2012).
namespace trackbed {

/// A path to be found between two cells, of a GridMap's columns and rows: the first row at the
/// bottom, where the file counts from the top.
struct MovingAiInstance {
  int line = 0;     ///< of the file
  int bucket = 0;   ///< the file's group of instances of like length
  std::string map;  ///< the name of its file
  int columns = 0;  ///< of the map
  int rows = 0;
  int start_column = 0;
  int start_row = 0;
  int goal_column = 0;
  int goal_row = 0;
  /// Of the shortest path, as listed [cells]: steps of 1, and of sqrt(2) where both adjacent cells
  /// are free.
  double length = 0.0;
};

/// Reads a `.scen` file of version 1. InputError with the line of every problem: another version,
/// too few or too many fields, a number that is none, a cell that is not on the map.
std::vector<MovingAiInstance> ReadMovingAiInstances(const std::filesystem::path& file);

}  // namespace trackbed
