#pragma once

#include <optional>

#include "trackbed/geometry/pose.h"

/// Options for making a plant, besides its car and world.
namespace trackbed {

/// The state of the vehicle at the start of a run.
struct StartState {
  Pose2 pose;             ///< Position of the rear-axle center, and yaw angle.
  double speed = 0.0;     ///< Speed [m/s].
  double steering = 0.0;  ///< Steering angle of wheels and actuator, in the bicycle model [rad].
  /// Lateral speed of the rear axle, to the left [m/s]; nullopt: no slip. Plants without slip
  /// ignore the value.
  std::optional<double> lateral_speed{};
  std::optional<double> yaw_rate{};  ///< Yaw rate [rad/s]; nullopt: the yaw rate without slip.
};

/// The tyre model of the MuJoCo plant.
enum class TyreLaw {
  /// kMagicFormula if the car's file has Magic Formula coefficients, else kContact.
  kAuto,
  kContact,  ///< MuJoCo's friction cone, with negligible slip below the friction limit.
  /// Magic Formula (vehicle/magic_formula.h): longitudinal and lateral forces grow with slip.
  kMagicFormula,
};

/// How the commanded steering angle reaches the road wheels.
enum class SteeringInput {
  kActuator,    ///< The car's steering actuator follows the command within its rate and angle
                ///< limits.
  kPrescribed,  ///< The wheels follow the command exactly and immediately, for validation.
};

}  // namespace trackbed
