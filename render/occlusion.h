#pragma once

#include "render/camera.h"
#include "render/recording.h"

namespace trackbed::render {

/// A box in the world with a vertical axis.
struct UprightBox {
  OrientedBox footprint;
  double bottom = 0;  ///< [m]
  double top = 0;     ///< [m]
};

/// Returns the fraction of the car, in [0, 1], that a box hides from a camera. The result is the
/// fraction of the car's sample points whose line of sight to the camera intersects the box. The
/// car is at `pose`, with its rear axle on ground of height `ground` [m]. The box is enlarged
/// horizontally by half a meter on each side and at its top, so that the fraction already rises
/// before the box hides the car.
double HiddenShare(const UprightBox& box, const CameraPose& camera, const CarBox& car,
                   const Pose2& pose, double ground);

/// Returns the opacity, in [0.25, 1], for an obstacle that hides this fraction of the car.
double FadedAlpha(double hidden_share);

}  // namespace trackbed::render
