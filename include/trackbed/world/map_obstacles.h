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
  /// InternalError unless the map has as many cells as it needs.
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

/// A map of a world, and its source.
struct MapSpec {
  std::string file;              ///< a YAML file of ROS's map_server, or a .map of Moving AI
  std::optional<double> cell{};  ///< side of a cell [m], > 0; only for a .map file, which has none
  /// Position and direction of the outer corner of the cell at the bottom left; default: the
  /// file's, or 0.
  std::optional<double> x{};    ///< [m]
  std::optional<double> y{};    ///< [m]
  std::optional<double> yaw{};  ///< direction of the rows [rad]
  UnknownCells unknown = UnknownCells::kFree;
  double height = 1.0;  ///< of the walls [m], > 0

  // Not a key: the map itself, shared by all worlds copied from one.
  std::shared_ptr<const MapObstacles> data{};
};

}  // namespace trackbed
