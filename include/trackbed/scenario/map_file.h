#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "trackbed/world/map_obstacles.h"

/// Files of grid maps. The formats are those of ROS's map_server (a YAML file and an image) and of
/// the Moving AI benchmarks (Sturtevant 2012).
namespace trackbed {

/// The file names of a map in a run folder, in the format of MapYaml and MapPgm.
inline constexpr const char* kMapYaml = "map.yaml";
inline constexpr const char* kMapPgm = "map.pgm";

/// Limits on a map: bytes of a file, number of cells, and number of walls.
inline constexpr std::size_t kMaxMapFileBytes = std::size_t{64} << 20U;
inline constexpr std::size_t kMaxMapCells = 20'000'000;
inline constexpr std::size_t kMaxWalls = 20'000;

/// Function that returns why a file must not be read, as the end of a sentence; empty if the file
/// may be read.
using AccessCheck = std::function<std::string(const std::filesystem::path& file)>;

/// Reads a map of map_server from its YAML file:
///
///     image, resolution [m], origin [x, y, yaw]  required
///     mode: trinary or scale                     default trinary
///     negate: 0 or 1                             required
///     occupied_thresh in (0, 1)                  required
///     free_thresh in (0, occupied_thresh]        required
///
/// The image is a PGM (P2, P5) or a PNG file. A pixel has the darkness d = 1 - v/v_max, where v is
/// its gray value, or the mean of red, green and blue. With `negate`, the darkness is d = v/v_max.
/// A pixel is occupied if d > occupied_thresh, free if d < free_thresh, otherwise unknown. In mode
/// `scale`, a pixel that is not opaque is also unknown. If d is between the thresholds in mode
/// `scale`, map_server converts d to a probability, whereas ReadRosMap reads an unknown cell. Mode
/// `raw` is not supported.
///
/// InputError lists every problem of the YAML file, with line, column and key, or the first problem
/// of the image. Calls `access_error` before reading the image.
GridMap ReadRosMap(const std::filesystem::path& file, const AccessCheck& access_error = {});

/// Reads a Moving AI file of type `octile`. The characters `.` and `G` are free cells; `@`, `O`,
/// `T`, `S` and `W` are occupied cells. The first row of the file is the top row of the map. The
/// argument `cell` [m] is the size of the cells, `X_WM` the pose of the map's lower left corner.
/// InputErrors have line and column.
GridMap ReadMovingAiMap(const std::filesystem::path& file, double cell, const Pose2& X_WM = {});

/// Whether the file is a Moving AI map, judged by the extension `.map`.
bool IsMovingAiMap(const std::filesystem::path& file);

/// Whether the file has the keys `image` and `resolution`, which ROS maps have and scenarios do
/// not. False if the file cannot be read.
bool IsRosMap(const std::filesystem::path& file);

/// Reads the map that a scenario names, relative to `folder`, and makes its walls. Throws the
/// InputErrors of the functions above. InputError with the key of `spec` for problems outside the
/// files, and for more than kMaxWalls walls.
MapObstacles ReadMap(const MapSpec& spec, const std::filesystem::path& folder,
                     const AccessCheck& access_error = {});

/// Formats the map as files of map_server with all digits, from which ReadRosMap restores an equal
/// map. The files are `map.yaml`, and `map.pgm` with 0 for occupied, 254 for free and 205 for
/// unknown.
std::string MapYaml(const GridMap& map);
std::string MapPgm(const GridMap& map);

}  // namespace trackbed
