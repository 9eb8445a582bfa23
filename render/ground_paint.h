#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <vector>

#include "render/image.h"
#include "trackbed/world/world.h"

/// Computes flat tiles of paint on flat or uneven ground.
namespace trackbed::render {

/// A translucent rectangle.
struct Tile {
  Eigen::Vector3d center;
  Eigen::Matrix3d rotation;  ///< Orientation R_WT of the tile, whose z axis is the ground's normal.
  double half_length = 0.0;  ///< Half length of the tile [m].
  double half_width = 0.0;   ///< Half width of the tile [m].
  Color color;
  float alpha = 1.0F;
};

/// Returns the color of a patch of ground with the given friction factor. Very low friction factors
/// yield the light blue of ice. Other slippery patches look like wet road, which is darker for
/// lower friction. Patches with a friction factor above 1 are brownish.
Color PatchColor(double friction);

/// Returns the color of a friction patch on asphalt.
Color PatchColorOnRoad(double friction);

/// Returns the world's friction patches, cut into flat tiles. The ground under a tile deviates from
/// a plane by at most 1.5 mm, unless the tile's sides have reached the minimum of 0.1 m. The tiles
/// lie 1 to 2 mm above the ground; tiles of patches that are later in the list lie above those of
/// earlier patches.
std::vector<Tile> PatchTiles(const World& world);

/// Cuts a rectangle on the ground into flat tiles, such that the ground under each tile deviates
/// from a plane by at most `tolerance` [m]. The tiles lie at the height `above` above the ground
/// [m] and have the color of the tile `like`.
std::vector<Tile> CutToGround(const Ground& ground, const OrientedBox& box, const Tile& like,
                              double above, double tolerance);

/// Appends a tile to the scene, unless the scene is full.
void AddTile(mjvScene& scene, const Tile& tile);

}  // namespace trackbed::render
