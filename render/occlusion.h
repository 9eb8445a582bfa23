#pragma once

#include "render/camera.h"
#include "render/recording.h"

namespace trackbed::render {

/// A box that stands upright in the world, rotated only about the vertical axis.
struct UprightBox {
  OrientedBox footprint;
  double bottom = 0;  ///< [m]
  double top = 0;     ///< [m]
};

/// Returns the fraction of the car, in [0, 1], that a box hides from a camera. The hidden fraction
/// is the number of sample points of the car whose line of sight to the camera intersects the box,
/// divided by the number of all sample points. The pose of the car is `pose`, with the rear axle on
/// ground of height `ground` [m]. HiddenShare enlarges the box by half a meter on each side and at
/// its top, so that the fraction already rises before the box hides the car.
double HiddenShare(const UprightBox& box, const CameraPose& camera, const CarBox& car,
                   const Pose2& pose, double ground);

/// Returns the opacity, in [0.25, 1], with which to draw an obstacle that hides the fraction
/// `hidden` of the car.
double FadedAlpha(double hidden_share);

}  // namespace trackbed::render
