#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/geometry/pose.h"

/// Lanes of a map beside a path, which films and reports show.
namespace trackbed {

/// A lane between two bounds in the direction of driving.
struct DrawnLane {
  std::vector<Vec2> left;   ///< Points of the left bound [m], at least two.
  std::vector<Vec2> right;  ///< Points of the right bound [m], as many as of `left`.
};

using DrawnLanes = std::vector<DrawnLane>;

/// The file name of the lanes in the run folder, next to the path.
inline constexpr const char* kLanesCsv = "lanes.csv";

/// The maximum number of points in a file of lanes.
inline constexpr std::size_t kMaxLanePoints = 1'000'000;

/// Returns the lanes whose bounding box comes within `reach` [m] of a point of the path. May also
/// return lanes that are up to 5 m farther away than `reach`. The returned lanes have at most
/// kMaxLanePoints points in total. The cost is proportional to the number of lanes times the length
/// of the path.
DrawnLanes LanesNear(const DrawnLanes& lanes, const std::vector<Vec2>& path, double reach);

/// Formats lanes as a CSV file with the columns `lane`, `left_x_m`, `left_y_m`, `right_x_m` and
/// `right_y_m`: a row for each pair of points of the two bounds. From the formatted file,
/// ReadLanesCsv reads lanes that are equal to `lanes`.
std::string LanesCsv(const DrawnLanes& lanes);

/// Reads lanes from the CSV file that LanesCsv writes. All rows of a lane must follow each other.
///
/// Throws InputError, with file and line, if a column is missing, or if a cell is not a finite
/// number of at most 1e7. Also throws InputError if a lane has only one row, or if there are more
/// than kMaxLanePoints rows. Throws RunError if the file cannot be read.
DrawnLanes ReadLanesCsv(const std::filesystem::path& file);

}  // namespace trackbed
