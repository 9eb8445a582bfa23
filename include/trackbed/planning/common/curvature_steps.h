#pragma once

#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"

/// Adapts a car's speed on paths of arcs and straights to the limited steering rate of its wheels.
///
/// At a joint between two segments, the curvature steps by dkappa [1/m] and the steering angle by
/// ddelta [rad]. The distance that the car drives at the speed v while its wheels turn by ddelta is
/// S = v |ddelta|/omega_delta [m]. If the wheels begin to turn at half of the distance S before the
/// joint, the car ends with the heading of the path, and with the lateral offset |dkappa| S^2/24
/// [m].
namespace trackbed {

/// Largest permitted lateral offset from the path due to a step of curvature [m].
inline constexpr double kStepDeviation = 0.1;

/// Returns the speed [m/s] at which a step of curvature between two pieces causes a lateral offset
/// of kStepDeviation. With the maximum steering rate omega_delta, the returned speed is v =
/// omega_delta sqrt(24 kStepDeviation/|dkappa|)/|ddelta|, or infinite if the curvature does not
/// step.
double StepSpeed(const VehicleParams& vehicle, double curvature_before, double curvature_after);

/// The stretch of the path on which the wheels turn to follow a step of curvature.
struct SteeringRamp {
  double joint = 0.0;  ///< Station of the curvature step [m].
  double from = 0.0;   ///< Station at which the steering ramp begins: the wheels begin to turn [m].
  double to = 0.0;     ///< Station at which the steering ramp ends: the wheels finish turning [m].
  /// Speed at which the wheels can follow the ramp, at most the requested speed [m/s].
  double speed = 0.0;
  double steering = 0.0;  ///< Change |ddelta| of the steering angle on the ramp [rad].
};

/// Returns, in order, the steering ramps at all steps of curvature at which the car does not stop.
/// The car is assumed to drive at `speed` [m/s], or more slowly within `caps`. Each steering ramp
/// is as long as the wheels need to turn at the car's speed, but covers at most half of each
/// adjacent piece, so that ramps never overlap. If a steering ramp is shortened to half of a piece,
/// the car drives more slowly on the ramp. Changes of direction and the stations `stops` have no
/// ramp, because the car stands while its wheels turn.
std::vector<SteeringRamp> RampsOfSteps(const VehicleParams& vehicle,
                                       const std::vector<Segment>& segments, double speed,
                                       const std::vector<SpeedCap>& caps = {},
                                       const std::vector<double>& stops = {});

/// Speeds and stops that keep a car on its path at steps of curvature.
struct StepSpeeds {
  /// Speed caps on the steering ramps. Each speed cap is the result of StepSpeed, or a lower speed
  /// if the adjacent pieces are short, but never less than the minimum speed.
  std::vector<SpeedCap> caps;
  /// Stations [m] of the joints between pieces that are too short for a steering ramp at the
  /// minimum speed. At each station in `stops`, the car stops and turns its wheels at rest.
  std::vector<double> stops;
};

/// Computes the speeds and stops that keep a car on its path at steps of curvature. The argument
/// `min_speed` [m/s], > 0, is the lowest speed on a steering ramp.
StepSpeeds PlanSteps(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                     double min_speed);

}  // namespace trackbed
