#pragma once

#include <optional>
#include <string>

#include "trackbed/path_files/path_file.h"

namespace trackbed {

/// The meaning of the numbers in a column of directions of motion. In every column of directions,
/// words such as "D", "R", "forward" and "reverse" are allowed, too.
enum class DirectionColumn {
  kSigned,   ///< Numbers: 1 forwards, -1 in reverse, 0 if the car stands.
  kGear,     ///< Gears: positive forwards, negative in reverse, 0 neutral.
  kForward,  ///< Flags: 1 or true forwards, 0 or false in reverse.
  kReverse,  ///< Opposite flags: 1 or true in reverse, 0 or false forwards.
};

/// Returns the direction of motion in a cell: 1, -1 or, if the car stands, 0. Returns nullopt if
/// the cell does not contain a direction.
std::optional<int> DirectionIn(const std::string& cell, DirectionColumn column);

/// Converts speeds that are negative in reverse to directions of motion and speeds of at least 0.
/// Keeps directions of motion that are already given and not 0.
void TakeSignedSpeeds(PathPoints& points);

/// Returns the problem, with its remedy, if the headings of points without directions of motion are
/// opposite to the direction of travel all along the path; else "". Opposite headings contradict a
/// column of speeds that are not negative.
std::string HalfTurnProblem(const PathPoints& points);

}  // namespace trackbed
