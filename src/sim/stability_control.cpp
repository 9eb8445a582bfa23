#include "src/sim/stability_control.h"

#include <algorithm>
#include <cmath>

#include "src/sim/wheel_slip_control.h"

namespace trackbed {
namespace {

/// Largest yaw rate reference, as a fraction of mu g/v (Rajamani 2012, 8.3).
constexpr double kLargestReference = 0.85;
/// Half width of the band about the yaw rate reference in which the control does not act, as a
/// fraction of mu g/v.
constexpr double kBand = 0.05;
/// Factor in the sideslip limit atan(kSideslip mu g) [s^2/m] (Rajamani 2012, 8.3).
constexpr double kSideslip = 0.02;
/// Time in which the commanded yaw moment would remove the yaw rate's excess over the permitted
/// band [s].
constexpr double kMomentTime = 0.02;
/// Times in which the drive torque decreases to 0 and increases to its full value [s].
constexpr double kCutTime = 0.1;
constexpr double kRestoreTime = 0.5;

/// Returns the amount by which `value` is outside the interval from -limit to limit.
double Excess(double value, double limit) {
  return value - std::clamp(value, -limit, limit);
}

/// Returns the delay of the yaw rate behind the steering angle at low frequencies, at the speed v
/// [s]. From steering angle delta to yaw rate r, the linear single-track model has the transfer
/// function
///   r/delta = (b_0 + b_1 s)/(a_0 + a_1 s + s^2),
/// whose delay is a_1/a_0 - b_1/b_0. The returned yaw delay is at most the time constant of the yaw
/// damping. This limit is needed near the critical speed of a car that oversteers.
double YawLag(const VehicleParams& car, double v) {
  const double front = car.cornering_stiffness_front;
  const double rear = car.cornering_stiffness_rear;
  const double l_f = car.cg_to_front();
  const double l_r = car.cg_to_rear;
  const double damping = l_f * l_f * front + l_r * l_r * rear;
  const double longest = car.yaw_inertia * v / damping;
  const double a_0 = front * rear * car.wheelbase * car.wheelbase / (car.mass * v) +
                     v * (l_r * rear - l_f * front);
  const double a_1 = (front + rear) * car.yaw_inertia / car.mass + damping;
  const double zero = car.mass * l_f * v / (rear * car.wheelbase);
  return a_0 > 0.0 ? std::clamp(a_1 / a_0 - zero, 0.0, longest) : longest;
}

}  // namespace

StabilityControl::StabilityControl(const CarModel& car, double gravity)
    : params_(car.unladen()),
      largest_{car.parts().brake_torque_front, car.parts().brake_torque_rear},
      gravity_(gravity) {
  const double front = params_.cornering_stiffness_front;
  const double rear = params_.cornering_stiffness_rear;
  understeer_ = params_.mass / params_.wheelbase *
                (params_.cg_to_rear / front - params_.cg_to_front() / rear);
}

double StabilityControl::Moment(const CarMotion& motion) const {
  const double grip = params_.friction_lateral * motion.road * gravity_;
  const double rotation =
      Excess(motion.yaw_rate - state_.yaw_rate_reference, kBand * grip / motion.speed);
  // The car spins if its heading turns away from the direction of its velocity.
  const bool spins = motion.sideslip * motion.yaw_rate < 0.0;
  const double sideslip =
      spins ? Excess(motion.sideslip, std::atan(kSideslip * grip)) / kMomentTime : 0.0;
  return params_.yaw_inertia / kMomentTime * (sideslip - rotation);
}

void StabilityControl::Update(const CarMotion& motion, double timestep) {
  const double v = motion.speed;
  const bool acts = v > std::sqrt(gravity_ * params_.wheelbase);
  const double grip = params_.friction_lateral * motion.road * gravity_;
  // A car that oversteers has no steady turn above its critical speed.
  const double length = std::max(1e-3, params_.wheelbase + understeer_ * v * v);
  const double limit = kLargestReference * grip / std::max(std::abs(v), 1e-3);
  const double steady = std::clamp(v * std::tan(motion.steering) / length, -limit, limit);
  const double lag = YawLag(params_, std::abs(v));
  double& reference = state_.yaw_rate_reference;
  reference = runs_ ? reference + timestep / (lag + timestep) * (steady - reference) : steady;
  runs_ = true;

  const double moment = acts ? Moment(motion) : 0.0;
  std::array<double, 4> wanted{};
  if (moment != 0.0) {
    // If the car oversteers, the commanded yaw moment is opposite to the yaw rate.
    const bool oversteers = moment * motion.yaw_rate < 0.0;
    const std::size_t side = moment > 0.0 ? 0 : 1;
    const double arm = 0.5 * (oversteers ? params_.track_front : params_.track_rear);
    wanted[(oversteers ? 0 : 2) + side] = std::abs(moment) / arm * params_.wheel_radius;
  }
  double braked = 0.0;
  for (std::size_t w = 0; w < wanted.size(); ++w) {
    const double largest = largest_[w / 2];
    double& torque = state_.brake_torque[w];
    torque = MoveBrakeTorque(torque, std::min(wanted[w], largest), largest, timestep);
    braked += torque;
  }
  const double change = braked > 0.0 ? -timestep / kCutTime : timestep / kRestoreTime;
  state_.drive_share = std::clamp(state_.drive_share + change, 0.0, 1.0);
}

}  // namespace trackbed
