#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/geometry/box_index.h"
#include "trackbed/world/grid_map.h"

/// Converts grid maps to obstacles of a world.
namespace trackbed {

/// The walls of a grid map: the map's blocked cells as obstacles. Immutable.
class MapObstacles {
 public:
  /// Throws InternalError unless the map has the number of cells that its columns and rows require.
  MapObstacles(GridMap map, UnknownCells unknown);

  [[nodiscard]] const GridMap& map() const { return map_; }

  /// Returns the walls in world coordinates: rectangles that cover the blocked cells exactly,
  /// without overlap.
  [[nodiscard]] const std::vector<OrientedBox>& boxes() const { return index_.boxes(); }

  /// Returns an index of the walls for fast distance queries.
  [[nodiscard]] const BoxIndex& index() const { return index_; }

 private:
  GridMap map_;
  BoxIndex index_;
};

/// The grid map of a world, with the options of the map's file.
struct MapSpec {
  /// File of the map: a YAML file in the format of ROS's map_server, or a `.map` file of Moving AI.
  std::string file;
  /// Length of a cell's side [m], > 0; only for a `.map` file, because these files contain no
  /// scale.
  std::optional<double> cell{};
  /// Pose of the map: the position of the outer corner of the bottom left cell, and the direction
  /// of the rows. The default pose of the map is the pose in the map file, or 0 if the file
  /// contains no pose.
  std::optional<double> x{};    ///< Coordinate x of the map's corner [m].
  std::optional<double> y{};    ///< Coordinate y of the map's corner [m].
  std::optional<double> yaw{};  ///< Direction of the map's rows [rad].
  UnknownCells unknown = UnknownCells::kFree;
  double height = 1.0;  ///< Height of the walls [m], > 0.

  // The walls of the map, which copies of the world share. The walls are computed from the map's
  // file, so the scenario file has no key for them.
  std::shared_ptr<const MapObstacles> data{};
};

}  // namespace trackbed
