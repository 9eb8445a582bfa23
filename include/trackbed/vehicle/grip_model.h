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
  double weight = 0.0;  ///< Fraction of the car's weight at rest [1].
  double track = 0.0;   ///< Track width [m].
  /// Fraction of the force on the road when braking (AxleGrip::force) [1].
  double braking = 0.0;
  double driving = 0.0;  ///< Fraction of the force on the road when driving [1].
  /// Roll stiffness of the chassis relative to the road: springs, anti-roll bar and tyres in series
  /// [N m/rad], > 0.
  double roll_stiffness = 0.0;
  double suspension_share = 0.0;  ///< Fraction of the roll angle that moves the springs [1].
  double camber_gain = 0.0;       ///< Value of CarTyres::camber_gain [rad/m].
  std::optional<MagicFormula> tyre;
  double friction = 0.0;  ///< Friction circle of tyres without a formula [1].
};

/// A car at steady state.
struct GripModel {
  LongitudinalForces forces;
  double wheelbase = 0.0;         ///< Wheelbase [m].
  double cg_height = 0.0;         ///< Height h of the center of gravity [m].
  double drag_height = 0.0;       ///< Height of the center of pressure [m].
  std::array<GripAxle, 2> axles;  ///< Front axle, rear axle.
};

/// The diagram on roads of the given friction factors.
///
/// At f_x, f_y and the drag D, an axle carries its fraction of the weight. The load transfer (m f_x
/// h + D (z_D - h))/L is added at the rear and subtracted at the front. The outer wheel of an axle
/// carries more and the inner wheel less. The load transfer across an axle is the axle's fraction
/// of the roll stiffness times m f_y h' over the axle's track. The height h' = h K/(K - m g h)
/// accounts for the shift of the weight in a rolling car.
///
/// Both wheels of an axle brake or drive equally, with the axle's fixed fraction, and have the same
/// slip angle. The axle's lateral force is the largest one over that angle at the given
/// longitudinal force. A car can sustain f_x and f_y if each axle sustains its fraction of the
/// weight times m f_y and no wheel locks or spins: the axle that slides first is the limit.
///
/// f_x is the sum of the forces along the wheels minus the drag of the slip angles. That drag is
/// f_y times the mean slip angle, weighted by the axles' loads. The drag opposes driving and adds
/// to braking.
///
/// The model neglects steering angles (their cosine is 1), yaw acceleration, the toe of the wheels,
/// aligning moments, and rolling resistance in the tyres' forces. PreconditionError unless masses,
/// tracks, loads and stiffnesses are positive. Cost: about 0.1 s for each road with Magic Formula
/// tyres.
GgvDiagram ComputeGgv(const GripModel& car, const std::vector<double>& roads);

/// The largest lateral specific force f_y [m/s^2] at f_x = `longitudinal` and speed 0 on a road of
/// the given factor. 0 if the axles cannot sustain f_x.
double MaxLateralForce(const GripModel& car, double road, double longitudinal);

/// A diagram for vehicles with unknown axles: an ellipse for each road, without drag. The half axes
/// are MaxAcceleration, MaxDeceleration and MaxLateralAcceleration. PreconditionError if a half
/// axis is 0.
GgvDiagram FrictionGgv(const VehicleParams& vehicle, const std::vector<double>& roads);

}  // namespace trackbed
