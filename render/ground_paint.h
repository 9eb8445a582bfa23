#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <vector>

#include "render/image.h"
#include "trackbed/world/world.h"

/// Flat paint on the ground of any shape.
namespace trackbed::render {

/// A translucent rectangle.
struct Tile {
  Eigen::Vector3d center;
  Eigen::Matrix3d rotation;  ///< R_WT; the tile's z axis is the ground's normal.
  double half_length = 0.0;  ///< Half length of the tile [m].
  double half_width = 0.0;   ///< Half width of the tile [m].
  Color color;
  float alpha = 1.0F;
};

/// Color of a friction factor. Ice is light blue. Slippery patches look like wet road, darker with
/// less friction. Patches with more grip than usual are brownish.
Color PatchColor(double friction);

/// The color of a patch seen on asphalt.
Color PatchColorOnRoad(double friction);

/// The world's friction patches, cut into tiles. Under a tile, the ground bends and twists by at
/// most 1.5 mm; the tile's sides are at least 0.1 m. Tiles lie 1 to 2 mm above the ground, later
/// patches above earlier ones.
std::vector<Tile> PatchTiles(const World& world);

/// A rectangle on the ground, cut into tiles under which the ground bends by at most `tolerance`
/// [m]. The tiles lie `above` the ground [m] and have the color of `like`.
std::vector<Tile> CutToGround(const Ground& ground, const OrientedBox& box, const Tile& like,
                              double above, double tolerance);

/// Appends a tile to the scene, unless the scene is full.
void AddTile(mjvScene& scene, const Tile& tile);

}  // namespace trackbed::render
