#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Largest extent of the positions of a recorded drive along x and along y [m]. All places of a
/// scenario have to be near one origin (scenario/local_origin.h).
inline constexpr double kMaxDriveExtent = 2e5;

/// Returns an error message if the positions [m] extend over more than kMaxDriveExtent, else "".
/// Positions that are too far apart mostly stem from a wrong number in the log. The message names
/// the two rows between which the position jumps farthest: `row_name(i)` is the name of row i, such
/// as "line 12".
std::string ExtentProblem(const std::vector<Vec2>& positions,
                          const std::function<std::string(std::size_t row)>& row_name);

}  // namespace trackbed
