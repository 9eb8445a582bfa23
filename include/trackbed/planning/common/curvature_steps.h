#pragma once

#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"

/// Paths of arcs and straights for wheels with a limited steering rate.
///
/// Symbols, for a joint where the curvature steps by dkappa [1/m] and the steering by ddelta [rad]:
/// S = v |ddelta|/omega_delta [m] is the distance rolled while the wheels turn. A ramp that begins
/// S/2 before the joint ends with the same heading, and a lateral offset of |dkappa| S^2/24 [m].
namespace trackbed {

/// The largest lateral offset that a step may cause [m].
inline constexpr double kStepDeviation = 0.1;

/// The speed at which a step of curvature between two pieces causes an offset of kStepDeviation: v
/// = omega_delta sqrt(24 kStepDeviation/|dkappa|)/|ddelta| [m/s]; infinite without a step.
double StepSpeed(const VehicleParams& vehicle, double curvature_before, double curvature_after);

/// The ramp in which the wheels follow one step of curvature.
struct SteeringRamp {
  double joint = 0.0;     ///< station of the step [m]
  double from = 0.0;      ///< [m]
  double to = 0.0;        ///< [m]
  double speed = 0.0;     ///< at which the wheels can follow: at most the requested one [m/s]
  double steering = 0.0;  ///< |ddelta| [rad]
};

/// The ramps of all steps that are driven through, in order, for a car that drives at `speed`
/// [m/s], slower within `caps`. Each is as long as the wheels need at this speed, but at most half
/// of each adjacent piece, so that ramps never overlap; a shortened ramp has a lower speed. Changes
/// of direction and `stops` have no ramp: the wheels turn there while the car stands.
std::vector<SteeringRamp> RampsOfSteps(const VehicleParams& vehicle,
                                       const std::vector<Segment>& segments, double speed,
                                       const std::vector<SpeedCap>& caps = {},
                                       const std::vector<double>& stops = {});

/// Speeds and stops with which a car takes its steps of curvature and stays on its path.
struct StepSpeeds {
  /// The stretches of the ramps, at the speed of StepSpeed or the lower one that the adjacent
  /// pieces allow, but not below the minimum speed.
  std::vector<SpeedCap> caps;
  /// Joints [m] between pieces too short for a ramp at the minimum speed: the car stops there and
  /// turns its wheels on the spot.
  std::vector<double> stops;
};

/// `min_speed` [m/s] > 0 is the lowest speed of a ramp.
StepSpeeds PlanSteps(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                     double min_speed);

}  // namespace trackbed
