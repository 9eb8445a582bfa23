#pragma once

#include <array>
#include <optional>
#include <vector>

#include "trackbed/vehicle/ggv_diagram.h"
#include "trackbed/vehicle/magic_formula.h"
#include "trackbed/vehicle/params.h"

/// Computes the g-g-v diagram of a car from its tyres, springs, brakes and drive.
namespace trackbed {

/// The parameters of an axle of a car.
struct GripAxle {
  double weight = 0.0;  ///< Fraction of the car's weight that the axle carries at rest [1].
  double track = 0.0;   ///< Track width [m].
  /// Fraction of the car's braking force that acts on this axle (AxleGrip::force) [1].
  double braking = 0.0;
  double driving = 0.0;  ///< Fraction of the car's driving force that acts on this axle [1].
  /// Roll stiffness of the axle between chassis and road, with springs, anti-roll bar and tyres in
  /// series [N m/rad], > 0.
  double roll_stiffness = 0.0;
  /// Fraction of the car's roll angle that deflects the springs of the axle (and not its tyres)
  /// [1].
  double suspension_share = 0.0;
  /// Change of camber per spring travel, equal to CarTyres::camber_gain [rad/m].
  double camber_gain = 0.0;
  std::optional<MagicFormula> tyre;
  double friction = 0.0;  ///< Friction coefficient of tyres without a Magic Formula [1].
};

/// The parameters of a car in steady-state motion.
struct GripModel {
  LongitudinalForces forces;
  double wheelbase = 0.0;    ///< Wheelbase [m].
  double cg_height = 0.0;    ///< Height h of the center of gravity [m].
  double drag_height = 0.0;  ///< Height z_D of the center of pressure, at which the drag acts [m].
  double steering_limit = 0.0;    ///< Largest steering angle [rad]; 0: neglect steering angles.
  std::array<GripAxle, 2> axles;  ///< The front axle and the rear axle of the car, in this order.
};

/// Computes the g-g-v diagram of a car on roads with the friction factors `roads`.
///
/// The longitudinal load transfer is (m f_x h + D (z_D - h))/L, with the mass m, the height h of
/// the center of gravity, the drag D at the height z_D, and the wheelbase L. The front axle carries
/// its fraction of the weight minus the load transfer. The rear axle carries its fraction of the
/// weight plus the load transfer. In a turn, the outer wheel of an axle carries more load than the
/// inner wheel. The lateral load transfer between the two wheels of an axle is m f_y h' (mass,
/// lateral force per mass, effective height) times the axle's fraction of the roll stiffness,
/// divided by the axle's track. The effective height h' of the center of gravity is h K/(K - m g
/// h), with the height h, the mass m, and the sum K of both axles' roll stiffnesses. The effective
/// height h' accounts for the lateral shift of the center of gravity in a rolling car.
///
/// Both wheels of an axle have the same braking or driving force and the same slip angle. Each axle
/// has a fixed fraction of the car's braking or driving force. The lateral grip of an axle is the
/// maximum of the lateral force over the slip angle, at the given longitudinal force. A car can
/// sustain the forces f_x and f_y if no wheel locks or spins, and if each axle can sustain its
/// fraction of the lateral force m f_y. The lateral force of the car is divided between the axles
/// in proportion to the weights that they carry at rest. The axle that slides first limits the
/// forces of the car.
///
/// In a turn with f_y on a level road, the front wheels have the steering angle delta = atan(L
/// f_y/v^2) + s_f - s_r, at most `steering_limit`, with the wheelbase L and the slip angles s_f and
/// s_r of the axles. The forces of the front wheels act along and across the wheels, and the outer
/// wheel has more lateral force than the inner one. The direction and the unequal size of the front
/// wheels' forces reduce the moment that turns the car. Large steering angles reduce the largest
/// lateral force f_y in tight turns: for a Prius by 5 % at a radius of 17 m. At each speed, the
/// reduction of the lateral force f_y in tight turns is computed only for the largest f_y. For a
/// smaller lateral force, the diagram has the longitudinal force of a car with straight wheels at
/// the same fraction of the largest lateral force.
///
/// The longitudinal force f_x is the sum of the forces along the wheels minus the cornering drag.
/// The cornering drag is the lateral force f_y times the mean slip angle of the axles, where each
/// axle is weighted by its fraction of the weight. The cornering drag opposes driving and adds to
/// braking.
///
/// The model neglects yaw acceleration, the toe of the wheels, aligning moments, and rolling
/// resistance in the tyres' forces. Throws PreconditionError unless masses, tracks, loads and
/// stiffnesses are positive. ComputeGgv takes about 0.1 s for each friction factor, if the car has
/// Magic Formula tyres.
GgvDiagram ComputeGgv(const GripModel& car, const std::vector<double>& roads);

/// Returns the largest lateral force f_y, divided by the car's mass [m/s^2], on a road with the
/// friction factor `road`. The force is computed without steering, at speed 0 and the longitudinal
/// force f_x = `longitudinal`. Returns 0 if the axles cannot sustain f_x. MaxLateralForce computes
/// one point of the diagram, for comparisons of the model with a measured or simulated car.
double MaxLateralForce(const GripModel& car, double road, double longitudinal);

/// Makes a g-g-v diagram for a vehicle with unknown axles. The g-g-v diagram has an ellipse for
/// each of the friction factors `roads`, and no drag. The half axes of each ellipse are
/// MaxAcceleration, MaxDeceleration and MaxLateralAcceleration. Throws PreconditionError if a half
/// axis of the ellipse is 0.
GgvDiagram FrictionGgv(const VehicleParams& vehicle, const std::vector<double>& roads);

}  // namespace trackbed
