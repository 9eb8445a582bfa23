#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/geometry/box_index.h"
#include "trackbed/world/grid_map.h"

/// Grid maps as obstacles of a world.
namespace trackbed {

/// The blocked cells of a map as walls. Immutable.
class MapObstacles {
 public:
  /// InternalError unless the map has the number of cells that its columns and rows require.
  MapObstacles(GridMap map, UnknownCells unknown);

  [[nodiscard]] const GridMap& map() const { return map_; }

  /// The walls in the world: rectangles that cover the blocked cells exactly, without overlap.
  [[nodiscard]] const std::vector<OrientedBox>& boxes() const { return index_.boxes(); }

  /// The walls, for distance queries.
  [[nodiscard]] const BoxIndex& index() const { return index_; }

 private:
  GridMap map_;
  BoxIndex index_;
};

/// A map of a world, and the file from which the map was read.
struct MapSpec {
  /// File of the map: a YAML file of ROS's map_server, or a .map of Moving AI.
  std::string file;
  /// Side of a cell [m], > 0; only for a .map file, which has no scale.
  std::optional<double> cell{};
  /// Position and direction of the outer corner of the cell at the bottom left. The default is the
  /// pose in the file, or 0.
  std::optional<double> x{};    ///< x of the corner [m].
  std::optional<double> y{};    ///< y of the corner [m].
  std::optional<double> yaw{};  ///< Direction of the rows [rad].
  UnknownCells unknown = UnknownCells::kFree;
  double height = 1.0;  ///< Height of the walls [m], > 0.

  // The map, shared by copies of the world. The member is not a key of the file.
  std::shared_ptr<const MapObstacles> data{};
};

}  // namespace trackbed
