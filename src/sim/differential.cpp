#include "src/sim/differential.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace trackbed {
namespace {

/// Returns the speed of a wheel at the end of a step in which the additional torque `added` acts on
/// the wheel [rad/s].
double SpeedAfter(const AxleWheel& wheel, double added, double timestep) {
  const double per_torque = timestep / wheel.inertia;
  const double free = wheel.speed + (wheel.torque + added) * per_torque;
  const double braked = wheel.friction * per_torque;
  return free - std::clamp(free, -braked, braked);
}

}  // namespace

double CouplingTorque(const AxleWheel& left, const AxleWheel& right, double most, double timestep) {
  const auto difference = [&](double c) {
    return SpeedAfter(left, c, timestep) - SpeedAfter(right, -c, timestep);
  };
  const double unlocked = difference(0.0);
  if (unlocked == 0.0 || most <= 0.0) {
    return 0.0;
  }
  // The transmitted torque opposes the difference of the wheel speeds. With the torque c = sign x,
  // the function sign * difference(sign x) increases with x, from a negative value at x = 0.
  const double sign = unlocked > 0.0 ? -1.0 : 1.0;
  const auto rising = [&](double x) { return sign * difference(sign * x); };
  // Transmitted torques with which the left and the right wheel, without dry friction, would end
  // the step at rest.
  const double to_rest_left = -(left.speed * left.inertia / timestep + left.torque);
  const double to_rest_right = right.speed * right.inertia / timestep + right.torque;
  // Transmitted torque that is large enough to change the sign of the difference of the wheel
  // speeds.
  const double enough =
      std::abs(to_rest_left) + left.friction + std::abs(to_rest_right) + right.friction;
  const double last = std::min(most, enough);
  std::array<double, 6> corners{0.0,
                                sign * (to_rest_left - left.friction),
                                sign * (to_rest_left + left.friction),
                                sign * (to_rest_right - right.friction),
                                sign * (to_rest_right + right.friction),
                                last};
  for (double& corner : corners) {
    corner = std::clamp(corner, 0.0, last);
  }
  std::sort(corners.begin(), corners.end());
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const double above = rising(corners[i]);
    if (above >= 0.0) {
      const double below = rising(corners[i - 1]);
      return sign * std::lerp(corners[i - 1], corners[i], below / (below - above));
    }
  }
  return sign * last;
}

}  // namespace trackbed
