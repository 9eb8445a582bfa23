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

/// How much of the car a box hides from a camera, in [0, 1]: the share of points of the car's box,
/// at `pose` with its rear axle on the ground at height `ground` [m], whose lines of sight go
/// through it. The box counts as half a meter larger to each side, so that the share rises before
/// it hides anything.
double HiddenShare(const UprightBox& box, const CameraPose& camera, const CarBox& car,
                   const Pose2& pose, double ground);

/// How opaque what hides that share of the car is drawn, in [0.25, 1].
double FadedAlpha(double hidden_share);

}  // namespace trackbed::render
