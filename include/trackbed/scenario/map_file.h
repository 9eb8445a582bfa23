#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "trackbed/world/map_obstacles.h"

/// Reads and writes files of grid maps, in the formats of ROS's map_server (a YAML file and an
/// image) and of the Moving AI benchmarks (Sturtevant 2012).
namespace trackbed {

/// The file names of a map in a run folder, in the format of MapYaml and MapPgm.
inline constexpr const char* kMapYaml = "map.yaml";
inline constexpr const char* kMapPgm = "map.pgm";

/// Limits on the size of a map: bytes of a file, number of cells, and number of walls.
inline constexpr std::size_t kMaxMapFileBytes = std::size_t{64} << 20U;
inline constexpr std::size_t kMaxMapCells = 20'000'000;
inline constexpr std::size_t kMaxWalls = 20'000;

/// Function that returns why a file must not be read; empty if the file may be read. The returned
/// text continues a message that begins with the file name ("lies outside of ...").
using AccessCheck = std::function<std::string(const std::filesystem::path& file)>;

/// Reads a map of map_server from its YAML file, which has these keys:
///
///     image, resolution [m], origin [x, y, yaw]  required
///     mode: trinary or scale                     default trinary
///     negate: 0 or 1                             required
///     occupied_thresh in (0, 1)                  required
///     free_thresh in (0, occupied_thresh]        required
///
/// The image is a PGM (P2, P5) or a PNG file. A pixel has the darkness d = 1 - v/v_max, where v is
/// the gray value of the pixel, or the mean of red, green and blue, and v_max the largest possible
/// value. If `negate` is 1, the darkness of a pixel with the gray value v is d = v/v_max. A pixel
/// with the darkness d is occupied if d > occupied_thresh, free if d < free_thresh, and otherwise
/// unknown. In mode `scale`, a pixel that is not opaque makes the cell unknown. In mode `scale`,
/// map_server converts a darkness between the two thresholds to a probability, whereas ReadRosMap
/// makes the cell unknown. The mode `raw` of map_server is not supported.
///
/// Throws InputError, which lists every problem of the YAML file with line, column and key, or the
/// first problem of the image. ReadRosMap calls `access_error` before reading the image, to check
/// that the image may be read.
GridMap ReadRosMap(const std::filesystem::path& file, const AccessCheck& access_error = {});

/// Returns true if the file has the keys `image` and `resolution`, which ROS maps have but
/// scenarios do not. Returns false if the file cannot be read.
bool IsRosMap(const std::filesystem::path& file);

/// Reads the map file that a scenario names, relative to `folder`, and makes the walls of the map.
/// Throws InputError if the map file is invalid, as ReadRosMap and ReadMovingAiMap do. Also throws
/// InputError, naming the key in `spec`, if an option is invalid or if there are more than
/// kMaxWalls walls.
MapObstacles ReadMap(const MapSpec& spec, const std::filesystem::path& folder,
                     const AccessCheck& access_error = {});

/// Formats the map as files in the format of map_server, with full precision, so that ReadRosMap
/// reads an equal map. The files are `map.yaml`, and the image `map.pgm`, in which occupied cells
/// are 0, free cells 254 and unknown cells 205.
std::string MapYaml(const GridMap& map);
std::string MapPgm(const GridMap& map);

}  // namespace trackbed
