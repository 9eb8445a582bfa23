#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/sim/car_parts.h"
#include "src/sim/mujoco_plant.h"
#include "src/sim/plants.h"
#include "trackbed/core/error.h"
#include "trackbed/vehicle/steering_actuator.h"

namespace trackbed {
namespace {

/// A vehicle with two driven wheels, each controlled by a speed servo with an integral part. In a
/// turn, the motors must apply the yaw moment m l_g v psi', because the center of gravity of the
/// mass m is at a distance l_g from the axle. A servo without integral part would apply this yaw
/// moment only at a speed error, so turns would be too wide.
class WheelPairPlant final : public MujocoPlant {
 public:
  explicit WheelPairPlant(const PlantSetup& setup)
      : MujocoPlant(setup), wanted_speed_(setup.start.speed), ratio_(setup.start.steering) {
    const WheelPairParts& parts = car().wheel_pair();
    RollWheels(parts.spin_dof, setup.start);
    for (std::size_t w = 0; w < parts.spin_dof.size(); ++w) {
      bearing_friction_[w] = model().dof_frictionloss[parts.spin_dof[w]];
    }
    Begin();
  }

  [[nodiscard]] std::unique_ptr<Plant> Clone() const override {
    return std::make_unique<WheelPairPlant>(*this);
  }

 private:
  void Act(const Command& command) override {
    const WheelPairParts& parts = car().wheel_pair();
    const VehicleParams& params = car().params();
    const double timestep = model().opt.timestep;
    ratio_ = MoveSteering({params.steering_limit, params.steering_rate}, ratio_, command.steering)
                 .At(timestep);
    if (command.coast) {
      Coast();
      return;
    }
    const double along_gear = command.acceleration * command.gear;
    const double speed = command.gear * Speed();
    const bool hold = along_gear <= 0.0 && speed < kAtRestSpeed;
    wanted_speed_ = hold ? 0.0 : command.gear * NextSpeed(command.gear, along_gear, speed);
    const WheelSpeeds speeds = RollingSpeeds(params, wanted_speed_, ratio_);
    for (std::size_t w = 0; w < parts.spin_dof.size(); ++w) {
      const double wanted = speeds[static_cast<Eigen::Index>(w)] / params.wheel_radius;
      const double missing = wanted - data().qvel[parts.spin_dof[w]];
      // Anti-windup limits the integral part of the speed servo to the value that yields the full
      // torque.
      integral_[w] = hold ? 0.0
                          : std::clamp(integral_[w] + missing * timestep / parts.integral_time,
                                       -parts.servo_slack, parts.servo_slack);
      data().ctrl[parts.actuator[w]] = wanted + integral_[w];
      model().dof_frictionloss[parts.spin_dof[w]] =
          bearing_friction_[w] + (hold ? parts.brake_torque : 0.0);
    }
  }

  /// Sets the speed commands of the servos to the present wheel speeds, so that the servos apply no
  /// torque.
  void Coast() {
    const WheelPairParts& parts = car().wheel_pair();
    wanted_speed_ = Speed();
    integral_.fill(0.0);
    for (std::size_t w = 0; w < parts.spin_dof.size(); ++w) {
      data().ctrl[parts.actuator[w]] = data().qvel[parts.spin_dof[w]];
      model().dof_frictionloss[parts.spin_dof[w]] = bearing_friction_[w];
    }
  }

  /// Returns the commanded speed for the coming step, in the direction of the gear [m/s].
  [[nodiscard]] double NextSpeed(int gear, double acceleration, double speed) const {
    const WheelPairParts& parts = car().wheel_pair();
    const double radius = car().params().wheel_radius;
    // The servos' torque saturates if commanded and actual vehicle speed differ by more than this
    // slack. Limiting the speed difference to the slack avoids windup of the servos.
    const double slack = parts.servo_slack * radius;
    const double wanted = gear * wanted_speed_;
    const double change = acceleration * model().opt.timestep;
    const double next = change > 0.0 ? std::min(wanted + change, std::max(wanted, speed + slack))
                                     : std::max(wanted + change, std::min(wanted, speed - slack));
    // Limits the vehicle's speed so that both motors stay below their maximum speed, with a reserve
    // for the servos' integral part. This speed limit makes the vehicle slow down in a turn instead
    // of leaving the commanded curve. In a turn, the outer wheel is 1 + |tan delta|/2 times as fast
    // as the vehicle.
    const double fastest =
        (parts.wheel_speed * radius - slack) / (1.0 + 0.5 * std::abs(std::tan(ratio_)));
    return std::clamp(next, 0.0, fastest);
  }

  [[nodiscard]] Wheels ObserveWheels() const override {
    const auto& spin = car().wheel_pair().spin_dof;
    const double radius = car().params().wheel_radius;
    const double left = radius * data().qvel[spin[0]];
    const double right = radius * data().qvel[spin[1]];
    const double speed = 0.5 * (left + right);
    // Speed below which the commanded value of tan(delta) gradually replaces the measured value
    // [m/s]. The measured tan(delta) is the difference of the wheel speeds divided by the vehicle's
    // speed; at rest, this quotient would consist of rounding errors.
    constexpr double kCrawl = 0.1;
    const double wanted = std::tan(ratio_);
    const double missing = right - left - speed * wanted;
    const double tangent = wanted + missing * speed / std::max(speed * speed, kCrawl * kCrawl);
    return {.actuator = ratio_, .steering = std::atan(tangent), .forces = {}};
  }

  double wanted_speed_;                       // Commanded speed [m/s].
  double ratio_;                              // Steering angle delta after the rate limit [rad].
  std::array<double, 2> integral_{};          // Integral part of each wheel's speed servo [rad/s].
  std::array<double, 2> bearing_friction_{};  // Friction torque of each wheel's bearing [N m].
};

}  // namespace

std::unique_ptr<Plant> MakeWheelPairPlant(const PlantSetup& setup) {
  if (setup.aids.any()) {
    throw InputError(Problem{.key = "vehicle.aids",
                             .message = fmt::format("{} has differential drive, whose motors turn "
                                                    "each wheel at its own speed; remove this",
                                                    setup.car.file())});
  }
  if (setup.tyre == TyreLaw::kMagicFormula) {
    static_cast<void>(SteeredParts(setup.car, "tyre: magic_formula"));
  }
  if (setup.steering == SteeringInput::kPrescribed) {
    static_cast<void>(SteeredParts(setup.car, "drive.steering: prescribed on the plant mujoco"));
  }
  return std::make_unique<WheelPairPlant>(setup);
}

}  // namespace trackbed
