#pragma once

#include "render/camera.h"
#include "render/recording.h"

namespace trackbed::render {

/// An upright box of the world.
struct UprightBox {
  OrientedBox footprint;
  double bottom = 0;  ///< [m]
  double top = 0;     ///< [m]
};

/// How much of the car a box hides from a camera, in [0, 1]. The result is the fraction of sample
/// points of the car's box whose lines of sight intersect the other box. The car is at `pose`, with
/// its rear axle on ground of height `ground` [m]. The box is enlarged by half a meter on each
/// side, so that the fraction rises before the box hides the car.
double HiddenShare(const UprightBox& box, const CameraPose& camera, const CarBox& car,
                   const Pose2& pose, double ground);

/// Opacity of an obstacle that hides this fraction of the car, in [0.25, 1].
double FadedAlpha(double hidden_share);

}  // namespace trackbed::render
