#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Look of an obstacle.
enum class ObstacleLook {
  kCar,    ///< The run's own car, as large as the obstacle.
  kWall,   ///< A wall, much longer than wide, with a dark top.
  kCone,   ///< A traffic cone.
  kPost,   ///< A white post with dark bands.
  kCrate,  ///< A box with darker edges.
};

/// The look for a size [m]. Cars are 3 to 6 long, 1.4 to 2.3 wide and 1.2 to 2.2 high. Walls are at
/// most 1 wide and at least four times as long. Cones and posts are at most 0.6 long and wide;
/// cones are up to 1 high. Obstacles of all other sizes are crates. `length` may be the shorter
/// side of the obstacle.
ObstacleLook ChooseLook(double length, double width, double height);

/// Draws the world's obstacles in their looks. An obstacle that the planner has not detected is
/// drawn as the outline of its edges.
OverlayEntry ObstacleOverlay();

}  // namespace trackbed::render
