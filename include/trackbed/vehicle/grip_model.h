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
  double weight = 0.0;  ///< Fraction of the car's weight that the axle carries at rest [1].
  double track = 0.0;   ///< Track width [m].
  /// Fraction of the car's braking force that acts on this axle (AxleGrip::force) [1].
  double braking = 0.0;
  double driving = 0.0;  ///< Fraction of the car's driving force that acts on this axle [1].
  /// Roll stiffness of the chassis relative to the road: springs, anti-roll bar and tyres in series
  /// [N m/rad], > 0.
  double roll_stiffness = 0.0;
  double suspension_share = 0.0;  ///< Fraction of the roll angle that moves the springs [1].
  double camber_gain = 0.0;       ///< Camber gain (CarTyres::camber_gain) [rad/m].
  std::optional<MagicFormula> tyre;
  double friction = 0.0;  ///< Friction coefficient of tyres without a Magic Formula [1].
};

/// A car in steady-state motion.
struct GripModel {
  LongitudinalForces forces;
  double wheelbase = 0.0;         ///< Wheelbase [m].
  double cg_height = 0.0;         ///< Height h of the center of gravity [m].
  double drag_height = 0.0;       ///< Height of the center of pressure [m].
  std::array<GripAxle, 2> axles;  ///< Front axle, rear axle.
};

/// Computes the g-g-v diagram of a car on roads with the given friction factors.
///
/// An axle carries its fraction of the weight plus (rear) or minus (front) the longitudinal load
/// transfer (m f_x h + D (z_D - h))/L. In this formula, h is the height of the center of gravity, L
/// the wheelbase, and D the drag, which acts at the height z_D. In a turn, the outer wheel of an
/// axle carries more than the inner wheel. The load transfer across an axle is the axle's fraction
/// of the roll stiffness times m f_y h', divided by the axle's track. The effective height h' = h
/// K/(K - m g h), with K the roll stiffness of both axles, accounts for the lateral shift of the
/// center of gravity in a rolling car.
///
/// Both wheels of an axle brake or drive equally, with the axle's fixed fraction, and have the same
/// slip angle. The lateral grip of an axle is the maximum of the lateral force over the slip angle,
/// at the given longitudinal force. A car can sustain f_x and f_y if each axle sustains its
/// fraction of the lateral force m f_y, in proportion to its weight, and no wheel locks or spins.
/// The axle that slides first is the limit.
///
/// The longitudinal force f_x is the sum of the forces along the wheels minus the cornering drag.
/// The cornering drag is f_y times the mean slip angle of the axles, weighted by their fractions of
/// the weight. The cornering drag opposes driving and adds to braking.
///
/// The model neglects steering angles (their cosine is 1), yaw acceleration, the toe of the wheels,
/// aligning moments, and rolling resistance in the tyres' forces. PreconditionError unless masses,
/// tracks, loads and stiffnesses are positive. Cost: about 0.1 s for each road with Magic Formula
/// tyres.
GgvDiagram ComputeGgv(const GripModel& car, const std::vector<double>& roads);

/// Returns the largest lateral force f_y per mass of the car [m/s^2], at the longitudinal force f_x
/// = `longitudinal` and speed 0, on a road with the given friction factor; 0 if the axles cannot
/// sustain f_x.
double MaxLateralForce(const GripModel& car, double road, double longitudinal);

/// Makes a diagram for vehicles with unknown axles: an ellipse for each road, without drag. The
/// half axes are MaxAcceleration, MaxDeceleration and MaxLateralAcceleration. PreconditionError if
/// a half axis is 0.
GgvDiagram FrictionGgv(const VehicleParams& vehicle, const std::vector<double>& roads);

}  // namespace trackbed
