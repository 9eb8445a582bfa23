#pragma once

#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"

/// Paths of arcs and straights for wheels that turn at a limited rate.
///
/// Symbols, for a joint where the curvature steps by dkappa [1/m] and the steering by ddelta [rad]:
/// S = v |ddelta|/omega_delta [m] rolled while the wheels turn. Begun S/2 before the joint, the
/// turn leads back to the same heading, |dkappa| S^2/24 beside the path [m].
namespace trackbed {

/// How far a step may lead off the path [m].
inline constexpr double kStepDeviation = 0.1;

/// The speed at which a step of curvature between two pieces leads off by kStepDeviation:
/// v = omega_delta sqrt(24 kStepDeviation/|dkappa|)/|ddelta| [m/s]; infinite without a step.
double StepSpeed(const VehicleParams& vehicle, double curvature_before, double curvature_after);

/// Stretches of S around every step, and one of S/2 at the start, wheels straight, at that speed,
/// or at one whose S is no longer than the pieces beside it, but not below `min_speed`. None at
/// changes of direction: there the wheels turn while the car stands.
std::vector<SpeedCap> CapsOfSteps(const VehicleParams& vehicle,
                                  const std::vector<Segment>& segments, double min_speed);

}  // namespace trackbed
