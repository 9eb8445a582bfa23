#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <vector>

#include "render/image.h"
#include "trackbed/world/world.h"

/// What is painted flat on the ground, whatever its shape.
namespace trackbed::render {

/// A translucent rectangle.
struct Tile {
  Eigen::Vector3d center;
  Eigen::Matrix3d rotation;  ///< R_WT; its z axis along the ground's normal
  double half_length = 0.0;  ///< [m]
  double half_width = 0.0;   ///< [m]
  Color color;
  float alpha = 1.0F;
};

/// How a friction factor looks: ice light blue, what is slippery as if wet, the darker the more,
/// and what grips more than usual brownish.
Color PatchColor(double friction);

/// How that color comes out on asphalt.
Color PatchColorOnRoad(double friction);

/// The world's friction patches, each cut into so many tiles that the ground bends and twists by no
/// more than 1.5 mm under any, as long as it does not have to be shorter than 0.1 m for that. They
/// lie 1 to 2 mm above the ground, later patches above earlier ones.
std::vector<Tile> PatchTiles(const World& world);

/// A rectangle on the ground, likewise cut so that the ground bends by no more than `tolerance` [m]
/// under any tile; `above` the ground [m], with the color of `like`.
std::vector<Tile> CutToGround(const Ground& ground, const OrientedBox& box, const Tile& like,
                              double above, double tolerance);

/// Appends a tile to the scene; nothing when the scene is full.
void AddTile(mjvScene& scene, const Tile& tile);

}  // namespace trackbed::render
