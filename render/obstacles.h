#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Kinds of appearance of an obstacle in a film.
enum class ObstacleLook {
  kCar,    ///< Obstacle as large as a car, drawn as the run's own car, scaled to size.
  kWall,   ///< Obstacle that is much longer than wide, drawn as a wall with a dark top.
  kCone,   ///< A traffic cone.
  kPost,   ///< Slender obstacle, drawn as a white post with dark bands.
  kCrate,  ///< Any other obstacle, drawn as a crate: a box with darker edges.
};

/// Chooses the appearance of an obstacle by its size [m]. Obstacles that are 3 to 6 m long, 1.4 to
/// 2.3 m wide and 1.2 to 2.2 m high are drawn as cars. Walls are at most 1 m wide and at least four
/// times as long as wide. Cones and posts are at most 0.6 m long and wide; cones are at most 1 m
/// high. Obstacles that are neither cars, walls, cones nor posts by their size are drawn as crates.
/// The argument `length` may be the shorter horizontal side of the obstacle.
ObstacleLook ChooseLook(double length, double width, double height);

/// Returns the overlay that draws each obstacle of the world with its ObstacleLook. An obstacle
/// that the planner has not detected yet is drawn as the outline of its box.
OverlayEntry ObstacleOverlay();

}  // namespace trackbed::render
