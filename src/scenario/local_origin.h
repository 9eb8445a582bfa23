#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "trackbed/road_network/open_drive.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/track/track.h"

/// The local origin of a scenario. Coordinates of map projections, such as those of UTM, are
/// millions of meters, too large for MuJoCo's heights and for pictures. Every coordinate of a
/// scenario with such large coordinates is therefore moved to a local origin, in one step after the
/// scenario was read.
namespace trackbed {

/// Largest distance of a place from the local origin, in x and in y [m]. A scenario whose places
/// are all within this distance of (0, 0) needs no local origin.
inline constexpr double kOriginReach = 1e5;

/// Moves all places of a scenario to its local origin: `scenario.origin` if it is set. Without
/// `scenario.origin`, chooses an origin if a coordinate exceeds kOriginReach. Sets
/// Scenario::origin. The start of a moved scenario becomes explicit, so that the resolved scenario
/// has exactly the same start. The scenario must have been read without problems. Returns the key
/// and the message of a problem if the places are in different coordinate systems.
std::optional<std::pair<std::string, std::string>> MoveToLocalOrigin(Scenario& scenario);

/// Returns the scenario in the coordinates of the scenario file: the inverse of MoveToLocalOrigin,
/// apart from the start. The contents of the scenario's files are moved only if `with_files` is
/// true.
Scenario InFileCoordinates(const Scenario& scenario, bool with_files);

/// Reads the local origin that the resolved scenario of a run states; (0, 0) if it states none.
/// Throws InputError if the file or the key cannot be read.
Vec2 ReadOrigin(const std::filesystem::path& file);

/// Returns a track whose points are moved by a vector [m].
Track Moved(const Track& track, const Vec2& by);

/// Moves the keys of a world, its map and its roads from the coordinates of the scenario file to
/// coordinates relative to a local origin.
void MoveToOrigin(World& world, const Vec2& origin);

/// Returns a road network whose coordinates are relative to a local origin of the scenario. If the
/// roads are near the origin only with the header's offset, the offset is added to the coordinates
/// of the file.
OpenDriveFile RoadsFrom(OpenDriveFile roads, const Vec2& origin);

}  // namespace trackbed
