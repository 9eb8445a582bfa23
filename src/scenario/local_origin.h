#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "trackbed/road_network/open_drive.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/track/track.h"

/// Local origins: a scenario with large coordinates is moved near (0, 0). Coordinates of map
/// projections, such as those of UTM, are millions of meters, too large for MuJoCo's heights and
/// for pictures. Every coordinate of a scenario with such large coordinates is therefore moved to a
/// local origin, in one step after the scenario was read.
namespace trackbed {

/// Largest distance of a place from the local origin, in x and in y [m]. A scenario whose places
/// are all within this distance of (0, 0) needs no local origin.
inline constexpr double kOriginReach = 1e5;

/// Moves all places of a scenario to its local origin: `scenario.origin` if it is set. Without
/// `scenario.origin`, MoveToLocalOrigin chooses an origin if a coordinate exceeds kOriginReach.
/// Sets Scenario::origin. In a moved scenario, the start position is stated explicitly, so that the
/// resolved scenario has exactly the same start. MoveToLocalOrigin requires a scenario that was
/// read without problems. If the places of the scenario are in different coordinate systems,
/// MoveToLocalOrigin returns the key and the message of this problem.
std::optional<std::pair<std::string, std::string>> MoveToLocalOrigin(Scenario& scenario);

/// Returns the scenario in the coordinates of the scenario file: the inverse of MoveToLocalOrigin,
/// apart from the start. The contents of the files that the scenario names are moved only if
/// `with_files` is true.
Scenario InFileCoordinates(const Scenario& scenario, bool with_files);

/// Reads the local origin from the resolved scenario of a run; returns (0, 0) if the file has no
/// local origin. ReadOrigin throws InputError if the file or its key `origin` cannot be read.
Vec2 ReadOrigin(const std::filesystem::path& file);

/// Returns a copy of the track whose points are moved by the vector `by` [m].
Track Moved(const Track& track, const Vec2& by);

/// Moves the coordinates in a world, its map and its roads from those of the scenario file to
/// coordinates relative to a local origin.
void MoveToOrigin(World& world, const Vec2& origin);

/// Returns a road network whose coordinates are relative to a local origin of the scenario. If the
/// roads are near the origin only with the offset in the OpenDRIVE header, the offset is added to
/// the coordinates of the file.
OpenDriveFile RoadsFrom(OpenDriveFile roads, const Vec2& origin);

}  // namespace trackbed
