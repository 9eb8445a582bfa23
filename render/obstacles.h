#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// Look of an obstacle.
enum class ObstacleLook {
  kCar,    ///< the run's own car, as large as the obstacle
  kWall,   ///< much longer than wide, with a dark top
  kCone,   ///< a traffic cone
  kPost,   ///< a white post with dark bands
  kCrate,  ///< a box with darker edges
};

/// The look for a size [m]: cars are 3 to 6 long, 1.4 to 2.3 wide and 1.2 to 2.2 high; walls are at
/// most 1 wide and at least four times as long; cones and posts are at most 0.6 long and wide,
/// cones up to 1 high; everything else is a crate. `length` may be the shorter side.
ObstacleLook ChooseLook(double length, double width, double height);

/// The world's obstacles in their looks; obstacles not yet detected by the planner as outlines of
/// their edges.
OverlayEntry ObstacleOverlay();

}  // namespace trackbed::render
