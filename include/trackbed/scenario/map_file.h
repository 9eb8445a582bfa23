#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "trackbed/world/map_obstacles.h"

/// Files of grid maps: of ROS's map_server (a YAML file and an image) and of the Moving AI
/// benchmarks (Sturtevant 2012).
namespace trackbed {

/// The file names of a map in a run folder, in the normal form of MapYaml and MapPgm.
inline constexpr const char* kMapYaml = "map.yaml";
inline constexpr const char* kMapPgm = "map.pgm";

/// Limits on a map: bytes of a file, cells, and walls.
inline constexpr std::size_t kMaxMapFileBytes = std::size_t{64} << 20U;
inline constexpr std::size_t kMaxMapCells = 20'000'000;
inline constexpr std::size_t kMaxWalls = 20'000;

/// Why a file must not be read, as the end of a sentence; empty if it may be read.
using AccessCheck = std::function<std::string(const std::filesystem::path& file)>;

/// Reads a map of map_server from its YAML file:
///
///     image, resolution [m], origin [x, y, yaw]  required
///     mode: trinary or scale                     default trinary
///     negate: 0 or 1                             required, as are
///     occupied_thresh, free_thresh               in (0, 1), the second not above the first
///
/// The image is a PGM (P2, P5) or a PNG file. A pixel has the darkness d = 1 - v/v_max, with v its
/// gray value, or the mean of red, green and blue; with `negate`, d = v/v_max. It is occupied if d
/// > occupied_thresh, free if d < free_thresh, otherwise unknown; in mode `scale` it is also
/// unknown unless it is opaque. (In mode `scale`, map_server makes d between the thresholds a
/// probability; here such pixels are unknown. Mode `raw` is not supported.)
///
/// InputError with every problem of the YAML file, with line, column and key, or the first one of
/// the image. Calls `access_error` before reading the image.
GridMap ReadRosMap(const std::filesystem::path& file, const AccessCheck& access_error = {});

/// Reads a Moving AI file of type `octile`: `.` and `G` are free; `@`, `O`, `T`, `S` and `W` are
/// occupied; rows count from the top. `cell` [m] is the size of its cells, `X_WM` the pose of its
/// lower left corner. InputError with line and column.
GridMap ReadMovingAiMap(const std::filesystem::path& file, double cell, const Pose2& X_WM = {});

/// Whether the file is assumed to be one of Moving AI, by its extension `.map`.
bool IsMovingAiMap(const std::filesystem::path& file);

/// Whether the file has the keys `image` and `resolution`, which ROS maps have and scenarios do
/// not. False when it cannot be read.
bool IsRosMap(const std::filesystem::path& file);

/// The map that a scenario names, relative to `folder`, with its walls. InputError as above, with
/// the key of `spec` for problems outside the files, and for more than kMaxWalls.
MapObstacles ReadMap(const MapSpec& spec, const std::filesystem::path& folder,
                     const AccessCheck& access_error = {});

/// The map as files of map_server with all digits; ReadRosMap reads them back to an equal map:
/// `map.yaml`, and `map.pgm` with 0 for occupied, 254 for free and 205 for unknown.
std::string MapYaml(const GridMap& map);
std::string MapPgm(const GridMap& map);

}  // namespace trackbed
