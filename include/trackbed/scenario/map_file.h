#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "trackbed/world/map_obstacles.h"

/// Files of grid maps: those of ROS's map_server (a YAML file and an image) and of the Moving AI
/// benchmarks (Sturtevant 2012).
namespace trackbed {

/// The map of a run folder, in the normal form of MapYaml and MapPgm.
inline constexpr const char* kMapYaml = "map.yaml";
inline constexpr const char* kMapPgm = "map.pgm";

/// No file of more bytes is read, no map of more cells is made, and none becomes more walls.
inline constexpr std::size_t kLargestMapFile = std::size_t{64} << 20U;
inline constexpr std::size_t kMostMapCells = 20'000'000;
inline constexpr std::size_t kMostWalls = 20'000;

/// Why a file may not be read, as the end of a sentence; empty when it may.
using WhyNot = std::function<std::string(const std::filesystem::path& file)>;

/// The map of a YAML file of map_server:
///
///     image, resolution [m], origin [x, y, yaw]  required
///     mode: trinary or scale                     default trinary
///     negate: 0 or 1                             required, as are
///     occupied_thresh, free_thresh               in (0, 1), the second not above the first
///
/// The image is a PGM (P2, P5) or a PNG file. A pixel is as dark as d = 1 - v/v_max, with v its
/// gray value, of colors the mean of red, green and blue; with `negate` d = v/v_max. It is occupied
/// if d > occupied_thresh, free if d < free_thresh, unknown else, and in mode `scale` where it is
/// not opaque. (map_server makes of d between the thresholds a probability in mode `scale`; here it
/// is unknown there, too. Mode `raw` is not read.)
///
/// InputError with every problem of the YAML file, with line, column and key, or the first of the
/// image. `why_not` is asked about the image before it is read.
GridMap ReadRosMap(const std::filesystem::path& file, const WhyNot& why_not = {});

/// The map of a Moving AI file of type `octile`: `.` and `G` are free; `@`, `O`, `T`, `S` and `W`
/// are occupied; rows count from the top. Its cells are `cell` [m] large, its lower left corner is
/// `X_WM`. InputError with line and column.
GridMap ReadMovingAiMap(const std::filesystem::path& file, double cell, const Pose2& X_WM = {});

/// Whether the file is taken for one of Moving AI: it ends in `.map`.
bool IsMovingAiMap(const std::filesystem::path& file);

/// Whether the file has the keys `image` and `resolution`, which ROS maps have and scenarios do
/// not. False when it cannot be read.
bool IsRosMap(const std::filesystem::path& file);

/// The map that a scenario names, relative to `folder`, with its walls. InputError as above, with
/// the key of `spec` where no file is to blame, and for more than kMostWalls.
MapObstacles ReadMap(const MapSpec& spec, const std::filesystem::path& folder,
                     const WhyNot& why_not = {});

/// The map as files of map_server, every digit of it, which ReadRosMap reads back to an equal one:
/// `map.yaml`, and `map.pgm` with 0 for occupied, 254 for free and 205 for unknown.
std::string MapYaml(const GridMap& map);
std::string MapPgm(const GridMap& map);

}  // namespace trackbed
