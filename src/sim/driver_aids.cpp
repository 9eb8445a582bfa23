#include "src/sim/driver_aids.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/sim/mujoco_compat.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

// Default parameters of a limited-slip differential. The differential's locking torque grows by a
// quarter of the drive torque, as for the plate differentials of road cars. The preload torque of
// the differential is 0.02 m g R, with the car's mass m and the wheel radius R: 80 N m for a car of
// 1300 kg.
constexpr double kPreload = 0.02;
constexpr double kRamp = 0.25;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

std::vector<DriverAids::DrivenAxle> FindDrivenAxles(const CarModel& car, const mjModel& model,
                                                    const mjData& data) {
  const CarParts& parts = car.parts();
  std::vector<DriverAids::DrivenAxle> axles;
  for (const std::size_t first : {std::size_t{0}, std::size_t{2}}) {
    const double left =
        mj::ActuatorMoment(model, data, parts.drive_actuator, parts.spin_dof[first]);
    const double right =
        mj::ActuatorMoment(model, data, parts.drive_actuator, parts.spin_dof[first + 1]);
    if (left != 0.0 && right != 0.0) {
      axles.push_back({first, left + right});
    }
  }
  return axles;
}

}  // namespace

DriverAids::DriverAids(const AidOptions& options, const CarModel& car, const mjModel& model,
                       const mjData& data)
    : options_(options), mass_(car.unladen().mass) {
  const double gravity = std::abs(model.opt.gravity[2]);
  const VehicleParams& params = car.unladen();
  const CarParts& parts = car.parts();
  if (options.differential != Differential::kOpen) {
    coupled_ = FindDrivenAxles(car, model, data);
    if (coupled_.empty()) {
      throw InputError(Problem{.key = "vehicle.aids.differential",
                               .message = fmt::format("the actuator 'drive' of {} drives no axle "
                                                      "with two wheels; must be open",
                                                      car.file())});
    }
  }
  preload_ =
      options.differential_preload.value_or(kPreload * params.mass * gravity * params.wheel_radius);
  ramp_ = options.differential_ramp.value_or(kRamp);
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const double arm = w < 2 ? params.cg_to_rear : params.cg_to_front();
    largest_[w] = w < 2 ? parts.brake_torque_front : parts.brake_torque_rear;
    slip_.emplace_back(MakeBrakedWheel(parts.tyres->axle[w / 2],
                                       0.5 * params.mass * gravity * arm / params.wheelbase,
                                       params.wheel_radius, parts.spin_inertia[w], largest_[w]));
  }
  if (options.esc) {
    esc_.emplace(car, gravity);
  }
}

void DriverAids::Update(const CarMotion& motion, const std::array<WheelMotion, 4>& wheels,
                        const std::array<double, 4>& brakes, double timestep) {
  std::array<double, 4> asked{};
  if (esc_) {
    esc_->Update(motion, timestep);
    asked = esc_->state().brake_torque;
  }
  double pull = 0.0;  // Sum of the tyres' longitudinal forces [N].
  for (const WheelMotion& wheel : wheels) {
    pull += wheel.longitudinal_force;
  }
  for (std::size_t w = 0; w < wheels.size(); ++w) {
    const double wanted = std::min(brakes[w] + asked[w], largest_[w]);
    if (options_.abs || asked[w] > 0.0) {
      // Stability control uses the road's friction factor as the least used friction. This keeps
      // the slip of the braked wheel at the peak of the tyre force, in turns too.
      const double least_use = asked[w] > 0.0 ? std::min(1.0, wheels[w].road) : 0.0;
      slip_[w].Update(wheels[w], wanted, pull / mass_, least_use, timestep);
    } else {
      slip_[w].Release();
    }
  }
  const std::array<double, 2> axle{FrontTorque(timestep), RearTorque()};
  for (std::size_t w = 0; w < wheels.size(); ++w) {
    const double wanted = std::min(brakes[w] + asked[w], largest_[w]);
    // A wheel that stability control brakes has only its own torque limit, not the torque limit of
    // its axle.
    const double shared = asked[w] > 0.0 ? kUnlimited : axle[w / 2];
    torque_[w] = std::min({wanted, slip_[w].limit(), shared});
    limited_[w] = torque_[w] < wanted;
    esc_torque_[w] = std::max(0.0, torque_[w] - brakes[w]);
  }
}

/// Returns the largest brake torque of a front wheel [N m]. The brake torque of the front wheel
/// with more grip may exceed that of the other front wheel by an excess that grows within a second.
/// The slow growth of the excess torque gives the driver time to steer against the yaw moment.
double DriverAids::FrontTorque(double timestep) {
  constexpr double kYawDelay = 1.0;  // [s]
  const double low = std::min(slip_[0].limit(), slip_[1].limit());
  if (!options_.abs || low == kUnlimited) {
    front_excess_ = 0.0;
    return kUnlimited;
  }
  front_excess_ = std::min(front_excess_ + largest_[0] * timestep / kYawDelay, largest_[0]);
  return low + front_excess_;
}

/// Returns the largest brake torque of a rear wheel [N m]. By select-low control, the rear wheel
/// with less grip limits the brake torque of both rear wheels.
double DriverAids::RearTorque() const {
  return options_.abs ? std::min(slip_[2].limit(), slip_[3].limit()) : kUnlimited;
}

double DriverAids::LargestCoupling(double drive) const {
  // The difference between the torques of the two wheels is twice the torque that the differential
  // transmits, hence the factor 0.5.
  return options_.differential == Differential::kLocked
             ? kUnlimited
             : 0.5 * (preload_ + ramp_ * std::abs(drive));
}

AidState DriverAids::state() const {
  AidState state;
  if (options_.abs) {
    state.abs_active = limited_;
  }
  if (esc_) {
    state.esc = esc_->state();
    state.esc->brake_torque = esc_torque_;
  }
  if (options_.differential != Differential::kOpen) {
    state.differential_torque = coupling_;
  }
  return state;
}

}  // namespace trackbed
