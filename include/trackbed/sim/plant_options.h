#pragma once

#include <optional>

#include "trackbed/geometry/pose.h"

/// Options with which a plant is made, in addition to its car and world.
namespace trackbed {

/// The state of the vehicle at the start of a run.
struct StartState {
  Pose2 pose;          ///< Position of the rear-axle center, and yaw angle of the vehicle.
  double speed = 0.0;  ///< Speed [m/s].
  /// Initial steering angle of the wheels and the actuator, as the angle of the bicycle model
  /// [rad].
  double steering = 0.0;
  /// Initial lateral speed of the rear axle, positive to the left [m/s]; nullopt: no slip. Plants
  /// that do not simulate slip ignore the initial lateral speed.
  std::optional<double> lateral_speed{};
  /// Initial yaw rate [rad/s]; nullopt: the yaw rate of a car without slip.
  std::optional<double> yaw_rate{};
  double hitch_angle = 0.0;  ///< Initial hitch angle of the trailer, if the car has one [rad].
};

/// The law by which the MuJoCo plant computes tyre forces.
enum class TyreLaw {
  /// Selects kMagicFormula if the car's file has Magic Formula coefficients, and kContact
  /// otherwise.
  kAuto,
  /// Tyre forces are contact forces within MuJoCo's friction cone, with negligible slip below the
  /// friction limit.
  kContact,
  /// Tyre forces follow the Magic Formula (vehicle/magic_formula.h), so that longitudinal and
  /// lateral forces grow with slip.
  kMagicFormula,
};

/// Selects how the road wheels follow the commanded steering angle.
enum class SteeringInput {
  kActuator,  ///< The car's steering actuator follows the command within its rate and angle
              ///< limits.
  /// The wheels follow the command exactly and immediately, which is meant for validation.
  kPrescribed,
};

}  // namespace trackbed
