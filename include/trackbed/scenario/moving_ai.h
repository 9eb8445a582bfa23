#pragma once

#include <filesystem>

#include "trackbed/geometry/pose.h"
#include "trackbed/world/map_obstacles.h"

/// Reads the maps of the Moving AI benchmarks (Sturtevant 2012).
namespace trackbed {

/// Reads a Moving AI file of type `octile`. The characters `.` and `G` are free cells; `@`, `O`,
/// `T`, `S` and `W` are occupied cells. The first row of the file is the top row of the map. The
/// argument `cell` [m] is the side of a cell, and `X_WM` is the pose of the map's lower left
/// corner. Throws InputError with line and column if the file is invalid.
GridMap ReadMovingAiMap(const std::filesystem::path& file, double cell, const Pose2& X_WM = {});

/// Whether the file name has the extension `.map` of Moving AI maps.
bool IsMovingAiMap(const std::filesystem::path& file);

}  // namespace trackbed
