#pragma once

#include "trackbed/control/steering_controller.h"

/// Limits of the steering angle by the grip of the tyres and by roll-over. WithActuatorModel
/// (actuator_model.h) applies the steering limits to every controller with feedback.
namespace trackbed {

/// Returns the lateral acceleration [m/s^2] at which the car slides or its inner wheels lift, on a
/// road with the friction factor 1. LateralGrip is the smaller one of mu_y g and g b/(2 h), with
/// the mean track b and the height h of the center of gravity. LateralGrip returns infinity if
/// friction and dimensions are unknown.
double LateralGrip(const VehicleParams& vehicle);

/// Fraction of the lateral grip that a car uses while it returns to its path. A step of the
/// steering angle makes an undamped car overshoot the steady lateral acceleration by a factor of 2.
inline constexpr double kReturnGripShare = 0.5;

/// Returns the steering angle [rad] of the steady turn that uses the whole LateralGrip at `speed`,
/// but at most the steering limit.
double SteeringAtGrip(const VehicleParams& vehicle, double speed);

/// Returns the largest steering angle [rad] that a control law commands at `speed`, even in a step:
/// the smaller of the steering limit and the angle of the steady turn with the lateral acceleration
/// a. Beyond the returned steering angle, the tyres slide without more lateral force, or a tall car
/// rolls over. The acceleration a follows from the grip and from roll-over:
///   a = min(mu_y g, c g b/(2 h) + (1 - c) a_0), c = 0.65.
/// A steering step from the lateral acceleration a_0 to a makes the car lean as in a steady turn
/// with a + (1/c - 1) (a - a_0). The equivalent lateral acceleration a + (1/c - 1) (a - a_0) must
/// not exceed the roll-over limit g b/(2 h). The argument `held` is a_0 >= 0 [m/s^2]: the lateral
/// acceleration of the steady turn to the same side that the car already drives. The steering angle
/// of the steady turn is the largest of three angles: of a car without slip, with linear tyres, and
/// with brush-model tyres. At the grip limit, an understeering car needs a larger steering angle
/// than the linear tyre model predicts. An oversteering car needs a larger steering angle to enter
/// a turn than to stay in the turn.
double SteeringInAStep(const VehicleParams& vehicle, double speed, double held = 0.0);

/// Returns the largest steering angle [rad] with which a car may turn round at `speed` [m/s]: the
/// smaller of the steering limit and the angle of the steady turn with kReturnGripShare times
/// LateralGrip. A car of unknown grip uses its steering limit.
double TurnRoundLimit(const VehicleParams& vehicle, double speed);

/// Range of steering angles [rad] that a control law may command.
struct SteeringRange {
  double lowest = 0.0;   ///< Rightmost angle, at most 0.
  double highest = 0.0;  ///< Leftmost angle, at least 0.
};

/// Returns the range of allowed steering angles for the car's present motion. The range is
/// SteeringInAStep to both sides, extended to the front axle's direction of motion, within the
/// steering limit. Wheels that roll in their direction of motion exert no lateral force, so a
/// sliding car may always steer into its slide.
///
/// The front tyres of an understeering car slide first. In a turn that the car holds at its limit,
/// the front tyres may need more steering than in the steady turn of the brush model. The load
/// transfer and the drive force on the inner wheel make the true grip smaller than the model's
/// grip. The range therefore extends toward the direction of the front axle plus 3 mu F_z/C_f, the
/// slip angle at which the front tyres slide. The extension is proportional to a_0/(mu_y g).
///
/// If the rear tyres slide first, or a step from a_0 lifts the inner wheels first, the range
/// extends toward a smaller slip angle: that of the front tyres in the steady turn with a. The
/// extension is then proportional to a_0/a. At this slip angle, the front tyres exert no more force
/// than in this steady turn, so the extension does not add a risk of rolling over. Drag and drive
/// force unload the front tyres, so a fast car needs more steering than the steady turn of the
/// brush model.
///
/// The argument `curvature` is the curvature of the path at the car [1/m]. The lateral acceleration
/// a_0 of SteeringInAStep is the smaller of the car's present lateral acceleration and the path's.
/// If the accelerations of the car and of the path have opposite signs, a_0 is 0. A turn that only
/// the path or only the car has begun is therefore not regarded as a steady turn.
SteeringRange AllowedSteering(const VehicleParams& vehicle, const VehicleState& state,
                              double curvature = 0.0);

/// Returns the largest steering angle [rad] >= 0 of the steady turns on the path, from the car's
/// station to `distance` [m] ahead, but at most SteeringInAStep of a car that holds this turn. The
/// speed of a turn is the planned speed plus the present excess of the car's speed. A control law
/// that plans ahead needs this angle: AllowedSteering is smaller as long as the car has not begun
/// to turn. Cost: O(n) for a path of n segments.
double SteeringAhead(const ControlInput& input, double distance);

}  // namespace trackbed
