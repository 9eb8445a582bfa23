#pragma once

#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"

/// Adapts the speed on paths of arcs and straights to wheels with a limited steering rate.
///
/// Symbols, for a joint where the curvature steps by dkappa [1/m] and the steering by ddelta [rad]:
/// S = v |ddelta|/omega_delta [m] is the distance that the car drives while its wheels turn. If the
/// wheels begin to turn S/2 before the joint, the car ends with the heading of the path and with a
/// lateral offset of |dkappa| S^2/24 [m] from the path.
namespace trackbed {

/// The largest lateral offset from the path that a step of curvature may cause [m].
inline constexpr double kStepDeviation = 0.1;

/// Returns the speed [m/s] at which a step of curvature between two pieces causes a lateral offset
/// of kStepDeviation. The speed is v = omega_delta sqrt(24 kStepDeviation/|dkappa|)/|ddelta|, or
/// infinite without a step.
double StepSpeed(const VehicleParams& vehicle, double curvature_before, double curvature_after);

/// The stretch of the path on which the wheels turn to follow a step of curvature.
struct SteeringRamp {
  double joint = 0.0;  ///< Station of the step [m].
  double from = 0.0;   ///< Station at which the wheels begin to turn [m].
  double to = 0.0;     ///< Station at which the wheels finish turning [m].
  /// Speed at which the wheels can follow the ramp, at most the requested speed [m/s].
  double speed = 0.0;
  double steering = 0.0;  ///< Steering step |ddelta| [rad].
};

/// Returns the steering ramps at all steps of curvature at which the car does not stop, in order.
/// The car drives at `speed` [m/s], or more slowly within `caps`. Each ramp is as long as the
/// wheels need at this speed, but covers at most half of each adjacent piece, so that ramps never
/// overlap. The car drives more slowly on a ramp that is shortened. Changes of direction and
/// `stops` have no ramp: the wheels turn while the car stands.
std::vector<SteeringRamp> RampsOfSteps(const VehicleParams& vehicle,
                                       const std::vector<Segment>& segments, double speed,
                                       const std::vector<SpeedCap>& caps = {},
                                       const std::vector<double>& stops = {});

/// Speeds and stops that keep a car on its path at steps of curvature.
struct StepSpeeds {
  /// Speed caps on the steering ramps. A cap is the speed of StepSpeed, or a lower speed if the
  /// adjacent pieces are short, but not less than the minimum speed.
  std::vector<SpeedCap> caps;
  /// Stations [m] of the joints between pieces that are too short for a ramp at the minimum speed.
  /// The car stops at such a joint and turns its wheels at rest.
  std::vector<double> stops;
};

/// Computes the speeds and stops that keep a car on its path at steps of curvature. `min_speed`
/// [m/s] > 0 is the lowest speed of a ramp.
StepSpeeds PlanSteps(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                     double min_speed);

}  // namespace trackbed
