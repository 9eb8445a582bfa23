#include "src/sim/wheel_slip_control.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trackbed {
namespace {

/// Time constant with which the brake slip approaches its target [s].
constexpr double kSlipTime = 0.02;
/// Part of the target slip that does not depend on the used friction, as a fraction of the largest
/// target slip. This fixed part of the target slip lets the wheel slip before the tyre force has
/// built up over the relaxation length.
constexpr double kSlipAtOnce = 0.1;
/// Longest time in which a tyre rolls over its relaxation length while slip control acts [s]. For a
/// tyre with a relaxation length of 0.3 m, slip control acts from 1.5 m/s on.
constexpr double kLongestRelaxation = 0.2;

}  // namespace

BrakedWheel MakeBrakedWheel(const MagicFormula& tyre, double load, double radius, double inertia,
                            double largest) {
  constexpr double kLargestSlip = 0.3;
  constexpr int kSteps = 300;
  BrakedWheel wheel{.radius = radius,
                    .inertia = inertia,
                    .largest = largest,
                    .slowest = tyre.relaxation_length / kLongestRelaxation};
  for (int i = 1; i <= kSteps; ++i) {
    const double slip = kLargestSlip * i / kSteps;
    const double friction =
        -EvaluateTyreForce(tyre, load, 1.0, {.ratio = -slip}).longitudinal / load;
    if (friction > wheel.peak_friction) {
      wheel.peak_slip = slip;
      wheel.peak_friction = friction;
    }
  }
  return wheel;
}

void WheelSlipControl::Update(const WheelMotion& motion, double wanted, double acceleration,
                              double least_use, double timestep) {
  const double speed = std::abs(motion.rolling_speed);
  if (speed < wheel_.slowest) {
    active_ = false;
    return;
  }
  // For a wheel that rolls and brakes, the quantities below are positive in either direction of
  // travel.
  const double ahead = motion.rolling_speed > 0.0 ? 1.0 : -1.0;
  const double spin = ahead * motion.spin;
  const double force = std::max(0.0, -ahead * motion.longitudinal_force);
  const double slip = 1.0 - spin * wheel_.radius / speed;
  const double use =
      motion.load > 0.0 ? std::min(1.0, force / (motion.load * wheel_.peak_friction)) : 0.0;
  const double target = wheel_.peak_slip * std::lerp(kSlipAtOnce, 1.0, std::max(use, least_use));
  const double target_spin = (1.0 - target) * speed / wheel_.radius;
  const double target_change = (1.0 - target) * ahead * acceleration / wheel_.radius;
  const double spin_change = target_change + (target_spin - spin) / kSlipTime;
  const double held =
      std::clamp(force * wheel_.radius - wheel_.inertia * spin_change, 0.0, wheel_.largest);
  if (!active_) {
    active_ = slip > target && held < wanted;
    limit_ = std::min(wanted, wheel_.largest);
  }
  if (active_) {
    limit_ = MoveBrakeTorque(limit_, held, wheel_.largest, timestep);
    active_ = limit_ < wanted;
  }
}

double WheelSlipControl::limit() const {
  return active_ ? limit_ : std::numeric_limits<double>::infinity();
}

double MoveBrakeTorque(double from, double to, double largest, double timestep) {
  constexpr double kRiseTime = 0.1;   // [s]
  constexpr double kFallTime = 0.05;  // [s]
  return std::clamp(to, from - largest * timestep / kFallTime,
                    from + largest * timestep / kRiseTime);
}

}  // namespace trackbed
