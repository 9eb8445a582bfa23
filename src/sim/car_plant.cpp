#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "src/sim/differential.h"
#include "src/sim/driver_aids.h"
#include "src/sim/magic_formula_tyres.h"
#include "src/sim/mujoco_compat.h"
#include "src/sim/mujoco_plant.h"
#include "src/sim/plants.h"
#include "src/sim/trailer_parts.h"
#include "src/sim/wheel_contacts.h"
#include "trackbed/core/error.h"

// Simulates a car with steered front wheels in MuJoCo. CarPlant implements three parts of a step:
//   1. In Act, the steering servo turns at a limited rate, or the steering angle is prescribed. The
//      motor or the brakes apply the torque that yields the commanded acceleration despite the
//      driving resistance.
//   2. In ApplyWheelForces, Magic Formula tyres (magic_formula_tyres.h) and dry friction act on the
//      wheels. Driver aids (driver_aids.h) change the torques of brakes and differential.
//   3. In Finish, the front wheels are turned to the Ackermann angles of the rack angle or of the
//      prescribed angle. The plant disables the polynomial joint coupling of the front wheels in
//      the model.
namespace trackbed {
namespace {

/// Armature inertia for locking a joint, so large that no torque of a car noticeably changes the
/// joint's speed [kg m^2].
constexpr double kLocked = 1e8;

/// Returns how the ground supports the car: by springs if the car has Magic Formula tyres, by
/// MuJoCo's contacts if it has contact tyres.
TyreSupport SupportFor(const PlantSetup& setup) {
  return SelectTyreLaw(setup.car, setup.tyre) == TyreLaw::kMagicFormula ? TyreSupport::kSprings
                                                                        : TyreSupport::kContacts;
}

class CarPlant final : public MujocoPlant {
 public:
  explicit CarPlant(const PlantSetup& setup)
      : MujocoPlant(setup, SupportFor(setup)),
        prescribed_(setup.steering == SteeringInput::kPrescribed) {
    const CarParts& parts = car().parts();
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      bearing_friction_[w] = model().dof_frictionloss[parts.spin_dof[w]];
    }
    dry_friction_ = bearing_friction_;
    if (SupportFor(setup) == TyreSupport::kSprings) {
      tyres_.emplace(car(), model(), TyreWheelsOfCar(car(), model()));
      if (car().trailer()) {
        trailer_tyres_.emplace(car(), model(), TyreWheelsOfTrailer(car(), model()));
      }
      for (const int spin : parts.spin_dof) {
        // the function HoldWheels applies the bearing friction instead of MuJoCo
        model().dof_frictionloss[spin] = 0.0;
      }
    }
    linked_ = ReleaseLinkage();
    if (linked_) {
      FollowRack();
    }
    RollWheels(parts.spin_dof, setup.start);
    data().act[parts.steer_state] = setup.start.steering;
    Begin();
    if (setup.aids.any()) {
      RequireTyresForAids();
      aids_.emplace(setup.aids, car(), model(), data());
    }
    if (tyres_) {
      tyres_->Stand(data());
      if (setup.start.lateral_speed || setup.start.yaw_rate) {
        tyres_->TakeLateralSlip(model(), data());
      }
    }
    if (trailer_tyres_) {
      trailer_tyres_->Stand(data());
    }
  }

  [[nodiscard]] std::optional<AidState> aids() const override {
    return aids_ ? std::optional(aids_->state()) : std::nullopt;
  }

  [[nodiscard]] std::unique_ptr<Plant> Clone() const override {
    return std::make_unique<CarPlant>(*this);
  }

 private:
  void Act(const Command& command) override {
    if (prescribed_) {
      PrescribeVelocity(command.steering);
    } else {
      Steer(command.steering);
    }
    Propel(command);
  }

  void ApplyWheelForces(const Road& road) override {
    if (tyres_) {
      tyres_->Apply(model(), data(), road);
      if (trailer_tyres_) {
        trailer_tyres_->Apply(model(), data(), trailer_road());
      }
      if (aids_) {
        Help(road);
      }
      HoldWheels();
    }
    if (linked_ && !prescribed_) {
      LoadRack();
    }
  }

  void Finish(const Command& command) override {
    if (prescribed_) {
      PrescribeAngle(command.steering);
    } else if (linked_) {
      FollowRack();
    }
  }

  [[nodiscard]] Wheels ObserveWheels() const override {
    return {.actuator = data().act[car().parts().steer_state],
            .steering = Steering(),
            .forces = tyres_ ? tyres_->Observe() : ContactWheelStates(car(), model(), data())};
  }

  /// Returns the steering angle of the bicycle model at the front wheels [rad].
  [[nodiscard]] double Steering() const {
    const auto& steer = car().parts().steer_qpos;
    return BicycleAngle(car().params(), {data().qpos[steer[0]], data().qpos[steer[1]]});
  }

  void Steer(double wanted);
  [[nodiscard]] bool ReleaseLinkage();
  void LoadRack();
  void FollowRack();
  void Propel(const Command& command);
  void Brake(double torque, bool hold);
  [[nodiscard]] double SpinTorque(std::size_t wheel) const;
  void HoldWheels();
  void RequireTyresForAids() const;
  void Help(const Road& road);
  void CoupleWheels();
  [[nodiscard]] double DriveLimit() const;
  [[nodiscard]] double Resistance(int gear) const;
  [[nodiscard]] double Grade() const;
  void PrescribeVelocity(double steering);
  void PrescribeAngle(double steering);

  // Whether the steering angle is prescribed instead of controlled by a servo.
  bool prescribed_;
  bool hold_ = false;                       // Whether the brakes hold the car at rest.
  bool linked_ = false;                     // Whether the front wheels are coupled to the rack.
  FrontAngles slopes_;                      // Derivatives of both front wheel angles with respect
                                            // to the rack angle.
  std::optional<MagicFormulaTyres> tyres_;  // Magic Formula tyres; nullopt if the car has contact
                                            // tyres.
  // Magic Formula tyres of the trailer; nullopt without a trailer or with contact tyres.
  std::optional<MagicFormulaTyres> trailer_tyres_;
  std::array<double, 4> bearing_friction_{};  // Friction torque of the bearing of each wheel [N m].
  // Maximum dry friction torque of bearing and brake on each wheel in this step [N m].
  std::array<double, 4> dry_friction_{};
  std::optional<DriverAids> aids_;  // Driver aids of the car; nullopt if the car has none.
};

void CarPlant::Steer(double wanted) {
  const VehicleParams& params = car().params();
  const double reachable = std::clamp(wanted, -params.steering_limit, params.steering_limit);
  const double rate = (reachable - data().act[car().parts().steer_state]) / model().opt.timestep;
  data().ctrl[car().parts().steer_actuator] =
      std::clamp(rate, -params.steering_rate, params.steering_rate);
}

/// Disables the model's coupling of the front wheels to the rack. The model's coupling is an
/// approximate polynomial; its error would make the front tyres push against each other. In place
/// of the model's coupling, FollowRack sets exact Ackermann angles. Returns false if the model has
/// no joint equalities that couple both front wheels to the rack.
bool CarPlant::ReleaseLinkage() {
  const CarParts& parts = car().parts();
  const auto follows_rack = [&](int joint_dof) {
    for (int i = 0; i < model().neq; ++i) {
      if (model().eq_type[i] == mjEQ_JOINT &&
          model().jnt_dofadr[model().eq_obj1id[i]] == joint_dof && model().eq_obj2id[i] >= 0 &&
          model().jnt_dofadr[model().eq_obj2id[i]] == parts.rack_dof) {
        return i;
      }
    }
    return -1;
  };
  const std::array<int, 2> coupling{follows_rack(parts.steer_dof[0]),
                                    follows_rack(parts.steer_dof[1])};
  if (coupling[0] < 0 || coupling[1] < 0) {
    return false;
  }
  for (std::size_t w = 0; w < coupling.size(); ++w) {
    mj::DisableEquality(model(), data(), coupling[w]);
    const int dof = parts.steer_dof[w];
    // Adds the inertia and damping of the steered wheels to the rack; the transmission ratio from
    // rack to wheels is taken as 1.
    model().dof_armature[parts.rack_dof] += model().dof_M0[dof];
    model().dof_damping[parts.rack_dof] += model().dof_damping[dof];
    model().dof_damping[dof] = 0.0;
  }
  mj::LockJoints(model(), parts.steer_dof, kLocked);
  return true;
}

/// Applies the torques of the front wheels about their steering axes to the rack. The torques
/// applied to the rack are those of the previous step.
void CarPlant::LoadRack() {
  const CarParts& parts = car().parts();
  const mjtNum* acceleration = data().qacc;
  data().qfrc_applied[parts.rack_dof] +=
      kLocked * (slopes_.left * acceleration[parts.steer_dof[0]] +
                 slopes_.right * acceleration[parts.steer_dof[1]]);
}

void CarPlant::FollowRack() {
  const CarParts& parts = car().parts();
  const double rack = data().qpos[parts.rack_qpos];
  const double rate = data().qvel[parts.rack_dof];
  const FrontAngles at = AckermannAngles(car().params(), rack);
  slopes_ = AckermannSlopes(car().params(), rack);
  data().qpos[parts.steer_qpos[0]] = at.left;
  data().qpos[parts.steer_qpos[1]] = at.right;
  data().qvel[parts.steer_dof[0]] = slopes_.left * rate;
  data().qvel[parts.steer_dof[1]] = slopes_.right * rate;
}

void CarPlant::Propel(const Command& command) {
  const CarParts& parts = car().parts();
  const double radius = car().params().wheel_radius;
  // mass of the car plus the rotational inertia of the wheels as an equivalent mass
  double rolling_mass = car().unladen().mass;
  for (const double inertia : parts.spin_inertia) {
    rolling_mass += inertia / (radius * radius);
  }
  if (const std::optional<TrailerParts>& trailer = car().trailer()) {
    rolling_mass += RollingMass(*trailer);
  }
  const double along_gear = command.acceleration * command.gear;
  const double resistance = Resistance(command.gear);
  // The brakes hold a stationary car until motion is commanded and the motor is strong enough for
  // the slope. The brakes of a coasting car are released.
  const bool overcomes_resistance = along_gear > 0.0 && DriveLimit() > resistance;
  const bool stands = Speed() * command.gear < kAtRestSpeed;
  hold_ = !command.coast && !overcomes_resistance && (hold_ || stands);
  if (command.coast) {
    data().ctrl[parts.drive_actuator] = 0.0;
    Brake(0.0, false);
    return;
  }
  // Wheel torque that yields the commanded acceleration against the driving resistance [N m]; the
  // motor applies a positive torque, the brakes a negative one.
  const double torque = along_gear * rolling_mass * radius + resistance;
  const bool drive = torque > 0.0 && !hold_;
  data().ctrl[parts.drive_actuator] = drive ? command.gear * std::min(torque, DriveLimit()) : 0.0;
  if (aids_) {
    data().ctrl[parts.drive_actuator] *= aids_->drive_share();
  }
  Brake(drive ? 0.0 : -torque, hold_);
}

/// Returns the maximum drive torque of the motor at the present speed [N m].
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
    dry_friction_[w] = bearing_friction_[w] + share * largest;
    if (!tyres_) {
      model().dof_frictionloss[parts.spin_dof[w]] = dry_friction_[w];
    }
  }
}

/// Returns the sum of the torques on a wheel about its spin axis, without dry friction [N m]. The
/// returned sum contains the drive torque of the previous step, which is small while the brakes are
/// applied.
double CarPlant::SpinTorque(std::size_t wheel) const {
  const int dof = car().parts().spin_dof[wheel];
  return data().qfrc_applied[dof] + data().qfrc_passive[dof] - data().qfrc_bias[dof] +
         data().qfrc_actuator[dof];
}

/// Applies the dry friction torques of bearings and brakes to the wheels. Each friction torque is
/// the torque that would stop the wheel within the step, limited to the available friction.
void CarPlant::HoldWheels() {
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const int dof = car().parts().spin_dof[w];
    const double torque = SpinTorque(w);
    const double inertia = car().parts().spin_inertia[w] + model().dof_armature[dof];
    const double stop = -inertia * data().qvel[dof] / model().opt.timestep - torque;
    data().qfrc_applied[dof] += std::clamp(stop, -dry_friction_[w], dry_friction_[w]);
  }
}

/// Throws InputError if the car has no Magic Formula tyres.
void CarPlant::RequireTyresForAids() const {
  if (tyres_) {
    return;
  }
  const std::string remedy =
      car().parts().tyres
          ? "use vehicle.tyre: magic_formula without the plant mujoco:contact"
          : fmt::format("{} has no tyre coefficients, so add them, or a vehicle.tyre_file",
                        car().file());
  throw InputError(Problem{
      .key = "vehicle.aids",
      .message = fmt::format("not on contact tyres, whose wheels hardly slip below the friction "
                             "limit and bounce beyond it; {}; or remove this",
                             remedy)});
}

/// Lets the driver aids change the brake torques, and applies the torques of the differentials.
void CarPlant::Help(const Road& road) {
  const CarParts& parts = car().parts();
  std::array<WheelMotion, 4> wheels;
  std::array<double, 4> brakes{};
  double loads = 0.0;
  double carried = 0.0;  // Sum of the wheel loads, each times the friction factor of the road under
                         // the wheel.
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    wheels[w] = tyres_->Motion(w);
    wheels[w].spin = data().qvel[parts.spin_dof[w]];
    wheels[w].road = road[w];
    brakes[w] = dry_friction_[w] - bearing_friction_[w];
    loads += wheels[w].load;
    carried += wheels[w].load * road[w];
  }
  const PlanarMotion motion = Motion();
  aids_->Update({.speed = motion.speed,
                 .yaw_rate = motion.yaw_rate,
                 .sideslip = motion.sideslip,
                 .steering = Steering(),
                 .road = loads > 0.0 ? carried / loads : 1.0},
                wheels, brakes, model().opt.timestep);
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    dry_friction_[w] = bearing_friction_[w] + aids_->brake_torque()[w];
  }
  CoupleWheels();
}

/// Applies the torques that locked or limited-slip differentials transmit between the wheels.
void CarPlant::CoupleWheels() {
  const CarParts& parts = car().parts();
  double sum = 0.0;
  for (const DriverAids::DrivenAxle& axle : aids_->coupled_axles()) {
    std::array<AxleWheel, 2> pair;
    for (std::size_t i = 0; i < pair.size(); ++i) {
      const std::size_t w = axle.first + i;
      const int dof = parts.spin_dof[w];
      pair[i] = {.speed = data().qvel[dof],
                 .inertia = parts.spin_inertia[w] + model().dof_armature[dof],
                 .torque = SpinTorque(w),
                 .friction = dry_friction_[w]};
    }
    const double drive = data().ctrl[parts.drive_actuator] * axle.drive_share;
    const double torque =
        CouplingTorque(pair[0], pair[1], aids_->LargestCoupling(drive), model().opt.timestep);
    data().qfrc_applied[parts.spin_dof[axle.first]] += torque;
    data().qfrc_applied[parts.spin_dof[axle.first + 1]] -= torque;
    sum += torque;
  }
  aids_->SetCoupling(sum);
}

/// Returns the total driving resistance from bearings, tyres, air and slope in the direction of the
/// gear, as a wheel torque [N m].
double CarPlant::Resistance(int gear) const {
  double dry = tyres_ ? tyres_->RollingMoment() : 0.0;
  for (const double friction : bearing_friction_) {
    dry += friction;
  }
  const double gravity = std::abs(model().opt.gravity[2]);
  double climb = car().unladen().mass * gravity * Grade();
  if (const std::optional<TrailerParts>& trailer = car().trailer()) {
    const TrailerParams& params = trailer->params;
    if (trailer_tyres_) {
      dry += trailer_tyres_->RollingMoment() * car().params().wheel_radius / params.wheel_radius;
    }
    climb += gravity * TrailerClimb(params, car().scene().ground, pose(),
                                    data().qpos[trailer->hitch_qpos[0]]);
  }
  return dry + gear * (Drag() + climb) * car().params().wheel_radius;
}

/// Returns the sine of the slope angle at the center of gravity, interpolated between the slopes
/// under the two axles.
double CarPlant::Grade() const {
  const Ground& ground = car().scene().ground;
  if (IsFlat(ground)) {
    return 0.0;
  }
  const VehicleParams& params = car().params();
  const Pose2 at = pose();
  const Vec2 ahead = Direction(at.yaw);
  const double front = GroundSlope(ground, ToWorld(at, {params.wheelbase, 0.0})).dot(ahead);
  const double rear = GroundSlope(ground, at.position()).dot(ahead);
  const double rise = std::lerp(rear, front, params.cg_to_rear / params.wheelbase);
  return rise / std::hypot(1.0, rise);
}

/// Sets the steering speeds of the front wheels so that the wheels reach the angles for `steering`
/// at the end of the step.
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

}  // namespace

std::unique_ptr<Plant> MakeCarPlant(const PlantSetup& setup) {
  return std::make_unique<CarPlant>(setup);
}

}  // namespace trackbed
