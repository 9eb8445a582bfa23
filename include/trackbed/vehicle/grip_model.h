#pragma once

#include <array>
#include <optional>
#include <vector>

#include "trackbed/vehicle/ggv_diagram.h"
#include "trackbed/vehicle/magic_formula.h"
#include "trackbed/vehicle/params.h"

/// The g-g-v diagram of a car from its tyres, springs, brakes and drive.
namespace trackbed {

/// An axle of a car.
struct GripAxle {
  double weight = 0.0;   ///< share of the car's weight at rest [1]
  double track = 0.0;    ///< [m]
  double braking = 0.0;  ///< share of the force on the road when braking (AxleGrip::force) [1]
  double driving = 0.0;  ///< likewise when driving [1]
  /// Against the road: springs, anti-roll bar and tyres in series [N m/rad], > 0.
  double roll_stiffness = 0.0;
  double suspension_share = 0.0;  ///< of the roll angle that moves the springs [1]
  double camber_gain = 0.0;       ///< CarTyres::camber_gain [rad/m]
  std::optional<MagicFormula> tyre;
  double friction = 0.0;  ///< of the tyres when they have no formula: a friction circle [1]
};

/// A car at steady state.
struct GripModel {
  LongitudinalForces forces;
  double wheelbase = 0.0;         ///< [m]
  double cg_height = 0.0;         ///< h [m]
  double drag_height = 0.0;       ///< of the center of pressure [m]
  std::array<GripAxle, 2> axles;  ///< front, rear
};

/// The diagram on roads of the given factors.
///
/// At f_x, f_y and the drag D, an axle carries its share of the weight and, the rear one more and
/// the front one less, (m f_x h + D (z_D - h))/L; its outer wheel more and its inner one less,
/// the part of the axle in the roll stiffness of m f_y h' over its track. h' = h K/(K - m g h) has
/// the weight that leans out in a car that rolls. Both wheels of an axle brake or drive alike, with
/// the axle's fixed share, and have the same slip angle; the axle's lateral force is the largest
/// one over it beside that longitudinal force. A car holds f_x and f_y if each axle holds its share
/// of the weight times m f_y and no wheel locks or spins: the axle that slides first is the limit.
/// f_x is what is left of the forces along the wheels after the drag of the slip angles, f_y times
/// their mean weighted by the axles' loads, against which the wheels are driven or which brakes.
///
/// Neglected: steering angles (their cosine is 1), yaw acceleration, the toe of the wheels,
/// aligning moments, rolling resistance in the tyres' forces. PreconditionError unless masses,
/// tracks, loads and stiffnesses are positive. Cost: about 0.1 s for each road with Magic Formula
/// tyres.
GgvDiagram ComputeGgv(const GripModel& car, const std::vector<double>& roads);

/// The largest lateral specific force f_y [m/s^2] at f_x = `longitudinal`, speed 0 and the road's
/// factor; 0 when the axles do not hold f_x.
double MaxLateralForce(const GripModel& car, double road, double longitudinal);

/// An ellipse for each road of what a vehicle's parameters say: half axes MaxAcceleration,
/// MaxDeceleration and MaxLateralAcceleration, no drag. For vehicles whose axles are not known.
/// PreconditionError where these parameters are 0.
GgvDiagram FrictionGgv(const VehicleParams& vehicle, const std::vector<double>& roads);

}  // namespace trackbed
