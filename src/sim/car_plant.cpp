#include <algorithm>
#include <cmath>
#include <optional>

#include "src/sim/magic_formula_tyres.h"
#include "src/sim/mujoco_plant.h"
#include "src/sim/wheel_contacts.h"

namespace trackbed {
namespace {

class CarPlant final : public MujocoPlant {
 public:
  explicit CarPlant(const PlantSetup& setup)
      : MujocoPlant(setup), prescribed_(setup.steering == SteeringInput::kPrescribed) {
    const CarParts& parts = car().parts();
    if (setup.tyre == TyreLaw::kMagicFormula) {
      tyres_.emplace(car(), model());
    }
    const auto rolling = RollingSpeeds(car().params(), setup.start.speed, setup.start.steering);
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      bearing_friction_[w] = model().dof_frictionloss[parts.spin_dof[w]];
      data().qvel[parts.spin_dof[w]] = rolling[w] / car().params().wheel_radius;
    }
    data().act[parts.steer_state] = setup.start.steering;
    Begin();
  }

 private:
  void Act(const Command& command) override {
    if (prescribed_) {
      PrescribeVelocity(command.steering);
    } else {
      Steer(command.steering);
    }
    Propel(command);
    loads_ = RoadLoads(car(), model(), data());  // of the last solve
  }

  void PushWheels(const Road& road) override {
    if (tyres_) {
      tyres_->Apply(model(), data(), loads_, road);
    }
  }

  void Finish(const Command& command) override {
    if (prescribed_) {
      PrescribeAngle(command.steering);
    }
  }

  [[nodiscard]] Wheels ObserveWheels() const override {
    const auto& steer = car().parts().steer_qpos;
    return {
        .actuator = data().act[car().parts().steer_state],
        .steering = BicycleAngle(car().params(), {data().qpos[steer[0]], data().qpos[steer[1]]}),
        .forces = tyres_ ? tyres_->wheels() : ContactWheels()};
  }

  void Steer(double wanted);
  void Propel(const Command& command);
  void Brake(double torque, bool hold);
  [[nodiscard]] double DriveLimit() const;
  [[nodiscard]] double Resistance(int gear) const;
  void PrescribeVelocity(double steering);
  void PrescribeAngle(double steering);
  [[nodiscard]] std::array<WheelState, 4> ContactWheels() const;

  bool prescribed_;                           // steering
  std::optional<MagicFormulaTyres> tyres_;    // none: contacts hold the wheels
  std::array<double, 4> loads_{};             // [N]
  std::array<double, 4> bearing_friction_{};  // [N m]
};

void CarPlant::Steer(double wanted) {
  const VehicleParams& params = car().params();
  const double reachable = std::clamp(wanted, -params.steering_limit, params.steering_limit);
  const double rate = (reachable - data().act[car().parts().steer_state]) / model().opt.timestep;
  data().ctrl[car().parts().steer_actuator] =
      std::clamp(rate, -params.steering_rate, params.steering_rate);
}

void CarPlant::Propel(const Command& command) {
  const CarParts& parts = car().parts();
  const double radius = car().params().wheel_radius;
  double rolling_mass = car().unladen().mass;  // with the wheels' own inertia
  for (const double inertia : parts.spin_inertia) {
    rolling_mass += inertia / (radius * radius);
  }
  const double along_gear = command.acceleration * command.gear;
  const bool hold = along_gear <= 0.0 && Speed() * command.gear < kStandstill;
  // What motor or brakes have to do beyond what slows the car anyway, as a torque at the wheels.
  const double torque = along_gear * rolling_mass * radius + Resistance(command.gear);
  const bool drive = torque > 0.0 && !hold;
  data().ctrl[parts.drive_actuator] = drive ? command.gear * std::min(torque, DriveLimit()) : 0.0;
  Brake(drive ? 0.0 : -torque, hold);
}

/// Largest drive torque at the speed now [N m].
double CarPlant::DriveLimit() const {
  const CarParts& parts = car().parts();
  const double full = parts.drive_limit * std::abs(Speed());
  const double power = parts.drive_power * car().params().wheel_radius;
  return parts.drive_power > 0.0 && full > power ? power / std::abs(Speed()) : parts.drive_limit;
}

void CarPlant::Brake(double torque, bool hold) {
  const CarParts& parts = car().parts();
  const double all = 2.0 * (parts.brake_torque_front + parts.brake_torque_rear);
  const double share = hold ? 1.0 : std::clamp(torque / all, 0.0, 1.0);
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const double largest = w < 2 ? parts.brake_torque_front : parts.brake_torque_rear;
    model().dof_frictionloss[parts.spin_dof[w]] = bearing_friction_[w] + share * largest;
  }
}

/// What bearings, rolling tyres and air take from a drive torque along the gear [N m].
double CarPlant::Resistance(int gear) const {
  double dry = tyres_ ? tyres_->RollingMoment() : 0.0;
  for (const double friction : bearing_friction_) {
    dry += friction;
  }
  return dry + gear * Drag() * car().params().wheel_radius;
}

/// The wheels move to `steering` during the coming step, whatever forces say.
void CarPlant::PrescribeVelocity(double steering) {
  const CarParts& parts = car().parts();
  const double timestep = model().opt.timestep;
  const FrontAngles to = AckermannAngles(car().params(), steering);
  data().qvel[parts.rack_dof] = (steering - data().qpos[parts.rack_qpos]) / timestep;
  data().qvel[parts.steer_dof[0]] = (to.left - data().qpos[parts.steer_qpos[0]]) / timestep;
  data().qvel[parts.steer_dof[1]] = (to.right - data().qpos[parts.steer_qpos[1]]) / timestep;
  data().ctrl[parts.steer_actuator] = 0.0;
}

void CarPlant::PrescribeAngle(double steering) {
  const CarParts& parts = car().parts();
  const FrontAngles at = AckermannAngles(car().params(), steering);
  data().qpos[parts.rack_qpos] = steering;
  data().qpos[parts.steer_qpos[0]] = at.left;
  data().qpos[parts.steer_qpos[1]] = at.right;
  data().act[parts.steer_state] = steering;
}

std::array<WheelState, 4> CarPlant::ContactWheels() const {
  const auto forces = RoadForces(car(), model(), data());
  const auto contacts = FindWheelContacts(car(), model(), data());
  std::array<WheelState, 4> wheels;
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const WheelContact& contact = contacts[w];
    // Slip is relative to the speed; near standstill to the speed at which a car counts as
    // standing.
    const double reference = std::max(std::abs(contact.rolling_speed), kStandstill);
    wheels[w] = {.normal_force = std::max(0.0, contact.up.dot(forces[w])),
                 .longitudinal_force = contact.forward.dot(forces[w]),
                 .lateral_force = contact.left.dot(forces[w]),
                 .slip_angle = std::atan2(contact.slip_speed_y, reference),
                 .slip_ratio = contact.slip_speed_x / reference};
  }
  return wheels;
}

}  // namespace

std::unique_ptr<Plant> MakeCarPlant(const PlantSetup& setup) {
  return std::make_unique<CarPlant>(setup);
}

}  // namespace trackbed
