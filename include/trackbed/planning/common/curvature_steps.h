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

/// Where the wheels take one step of curvature: from `from` to `to`, about the joint [m].
struct SteeringRamp {
  double joint = 0.0;     ///< station of the step [m]
  double from = 0.0;      ///< [m]
  double to = 0.0;        ///< [m]
  double speed = 0.0;     ///< at which the wheels can follow: at most the one asked for [m/s]
  double steering = 0.0;  ///< |ddelta| [rad]
};

/// The ramps of all steps that are driven through, in their order, for a car that goes at `speed`
/// [m/s], more slowly within `caps`: each as long as the wheels need at that speed, but no longer
/// than half of each piece beside it, so that ramps never overlap. Then its speed is lower than
/// asked for. Changes of direction and `stops` have none: there the wheels turn while the car
/// stands.
std::vector<SteeringRamp> RampsOfSteps(const VehicleParams& vehicle,
                                       const std::vector<Segment>& segments, double speed,
                                       const std::vector<SpeedCap>& caps = {},
                                       const std::vector<double>& stops = {});

/// How a car that has to keep to its path takes its steps of curvature.
struct StepSpeeds {
  /// The stretches of the ramps, at the speeds of StepSpeed or what the pieces beside them allow,
  /// but not below the least speed.
  std::vector<SpeedCap> caps;
  /// Joints [m] between pieces too short for a ramp at the least speed: the car stops there and
  /// turns its wheels on the spot.
  std::vector<double> stops;
};

/// `min_speed` [m/s] > 0: no ramp is driven more slowly.
StepSpeeds PlanSteps(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                     double min_speed);

}  // namespace trackbed
