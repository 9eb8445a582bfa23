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
  Eigen::Matrix3d rotation;  ///< R_WT; the z axis is the ground's normal
  double half_length = 0.0;  ///< [m]
  double half_width = 0.0;   ///< [m]
  Color color;
  float alpha = 1.0F;
};

/// Color of a friction factor: ice light blue, slippery patches like wet road (the more slippery,
/// the darker), patches with more grip than usual brownish.
Color PatchColor(double friction);

/// The resulting color on asphalt.
Color PatchColorOnRoad(double friction);

/// The world's friction patches, each cut into tiles under which the ground bends and twists by at
/// most 1.5 mm, but with sides of at least 0.1 m. They lie 1 to 2 mm above the ground, later
/// patches above earlier ones.
std::vector<Tile> PatchTiles(const World& world);

/// A rectangle on the ground, cut into tiles under which the ground bends by at most `tolerance`
/// [m]. The tiles lie `above` the ground [m] and have the color of `like`.
std::vector<Tile> CutToGround(const Ground& ground, const OrientedBox& box, const Tile& like,
                              double above, double tolerance);

/// Appends a tile to the scene, unless the scene is full.
void AddTile(mjvScene& scene, const Tile& tile);

}  // namespace trackbed::render
