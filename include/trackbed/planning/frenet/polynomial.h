#pragma once

#include <array>
#include <cstddef>

namespace trackbed {

/// A polynomial x(t) = sum c_i t^i of degree 5 or less.
struct Polynomial {
  std::array<double, 6> coefficients{};

  /// Returns the polynomial's derivative d^order x/dt^order at t, for an order from 0 to 5.
  /// Computing cost: at most five multiplications.
  [[nodiscard]] double At(double t, std::size_t order = 0) const;
  /// Returns the integral of the polynomial's squared derivative (d^order x/dt^order)^2 over [0,
  /// duration], in closed form.
  [[nodiscard]] double IntegralOfSquare(std::size_t order, double duration) const;

  bool operator==(const Polynomial&) const = default;
};

/// Position, velocity and acceleration of a motion along a line at one moment.
struct LineMotion {
  double position = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;
};

/// Returns the motion from the state `from` to the state `to` within `duration` > 0 for which the
/// integral of the squared jerk is smallest.
Polynomial QuinticBetween(const LineMotion& from, const LineMotion& to, double duration);

/// Same as QuinticBetween, but the end position is free. QuarticBetween ignores the position of the
/// state `to`.
Polynomial QuarticBetween(const LineMotion& from, const LineMotion& to, double duration);

}  // namespace trackbed
