#pragma once

#include "render/overlay.h"

namespace trackbed::render {

/// What an obstacle looks like.
enum class ObstacleLook {
  kCar,    ///< the run's own car, as large as the obstacle
  kWall,   ///< much longer than wide, with a dark top
  kCone,   ///< a traffic cone
  kPost,   ///< a white post with dark bands
  kCrate,  ///< a box with darker edges
};

/// By its size [m]: cars are 3 to 6 long, 1.4 to 2.3 wide and 1.2 to 2.2 high; walls at most a
/// meter wide and four times as long; cones and posts at most 0.6 to a side, cones up to a meter
/// high; everything else is a crate. `length` need not be the longer side.
ObstacleLook LookOf(double length, double width, double height);

/// The world's obstacles as what they are; those that the planner does not know yet as an outline
/// of their edges.
OverlayEntry ObstacleOverlay();

}  // namespace trackbed::render
