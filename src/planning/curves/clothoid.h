#pragma once

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Returns the integrals of cos(angle u^2) and of sin(angle u^2) over u from 0 to 1. The integrals
/// are the Fresnel integrals of a clothoid that turns by `angle` [rad] from curvature 0, per
/// length. Exact to 1e-13 for angles up to 100 rad.
Vec2 FresnelPerLength(double angle);

/// Returns the integral of cos(angle (1 - u^2)) over u from 0 to 1. The integral is the ratio of
/// chord to length for two symmetric clothoids that turn by `angle` [rad] each. The second clothoid
/// unwinds the curvature of the first. The ratio decreases from 1 at an angle of 0 to 0 at 2.3 rad.
double ChordPerLength(double angle);

}  // namespace trackbed
