#pragma once

#include "src/scenario/map_range.h"
#include "trackbed/options/key_visitor.h"
#include "trackbed/world/map_obstacles.h"

/// Declares the keys of the section `world.map` of a scenario.
namespace trackbed {

inline constexpr Range kSize{.max = 1e4, .above = 0.0};  // [m]
inline constexpr Range kMapCellSize{.min = 1e-3, .max = 1e3};

inline void Visit(KeyVisitor& a, MapSpec& map) {
  a.Field({"file", "", "YAML file of a ROS map (map_server), or a .map file of Moving AI"},
          map.file, Need::kRequired);
  a.Field({"cell", "m", "side of a cell; required with a .map file, not allowed with a ROS map"},
          map.cell, kMapCellSize);
  a.Field({"x", "m", "lower left corner of the map; default: the file's origin, or 0"}, map.x,
          kPlace);
  a.Field({"y", "m", "lower left corner of the map; default: the file's origin, or 0"}, map.y,
          kPlace);
  a.Field({"yaw", "rad", "direction of its rows; default: the file's origin, or 0"}, map.yaw,
          kDirection);
  static const EnumNames<UnknownCells> unknown{{UnknownCells::kFree, "free"},
                                               {UnknownCells::kOccupied, "occupied"}};
  a.Field({"unknown", "", "handling of cells that are neither free nor occupied in the file"},
          map.unknown, Need::kOptional, unknown);
  a.Field({"height", "m", "height of the walls"}, map.height, Need::kOptional, kSize);
}

}  // namespace trackbed
