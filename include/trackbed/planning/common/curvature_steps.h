#pragma once

#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"

/// Paths of arcs and straights for wheels with a limited steering rate.
///
/// Symbols, for a joint where the curvature steps by dkappa [1/m] and the steering by ddelta [rad]:
/// S = v |ddelta|/omega_delta [m] is the driven distance while the wheels turn. A ramp that begins
/// S/2 before the joint ends with the same heading, and a lateral offset of |dkappa| S^2/24 [m].
namespace trackbed {

/// The largest lateral offset that a step may cause [m].
inline constexpr double kStepDeviation = 0.1;

/// The speed [m/s] at which a step of curvature between two pieces causes an offset of
/// kStepDeviation. The speed is v = omega_delta sqrt(24 kStepDeviation/|dkappa|)/|ddelta|; infinite
/// without a step.
double StepSpeed(const VehicleParams& vehicle, double curvature_before, double curvature_after);

/// The ramp in which the wheels follow one step of curvature.
struct SteeringRamp {
  double joint = 0.0;  ///< Station of the step [m].
  double from = 0.0;   ///< Start station [m].
  double to = 0.0;     ///< End station [m].
  /// Speed at which the wheels can follow, at most the requested speed [m/s].
  double speed = 0.0;
  double steering = 0.0;  ///< Steering step |ddelta| [rad].
};

/// The ramps of all steps at which the car does not stop, in order. The car drives at `speed`
/// [m/s], slower within `caps`. Each ramp is as long as the wheels need at this speed, but at most
/// half of each adjacent piece, so that ramps never overlap. A shortened ramp has a lower speed.
/// Changes of direction and `stops` have no ramp: the wheels turn while the car stands.
std::vector<SteeringRamp> RampsOfSteps(const VehicleParams& vehicle,
                                       const std::vector<Segment>& segments, double speed,
                                       const std::vector<SpeedCap>& caps = {},
                                       const std::vector<double>& stops = {});

/// Speeds and stops that keep a car on its path at steps of curvature.
struct StepSpeeds {
  /// Caps on the stretches of the ramps: the speed of StepSpeed, or a lower speed if the adjacent
  /// pieces are short, but not below the minimum speed.
  std::vector<SpeedCap> caps;
  /// Joints [m] between pieces too short for a ramp at the minimum speed: the car stops at the
  /// joint and turns its wheels at rest.
  std::vector<double> stops;
};

/// Computes the speeds and stops. `min_speed` [m/s] > 0 is the lowest speed of a ramp.
StepSpeeds PlanSteps(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                     double min_speed);

}  // namespace trackbed
