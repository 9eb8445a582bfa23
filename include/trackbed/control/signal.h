#pragma once

#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// A quantity given at knots (x, value): linear between the knots, constant before the first and
/// after the last knot. The x of the knots are strictly increasing. Evaluating a signal without
/// knots is an InternalError.
struct Signal {
  std::vector<Vec2> knots;

  [[nodiscard]] bool empty() const { return knots.empty(); }

  /// The value at x, exact at the knots. Cost O(log knots).
  [[nodiscard]] double At(double x) const;

  /// The mean over [from, to], exact to rounding; the value at `from` if to <= from. Cost O(log
  /// knots + knots between).
  [[nodiscard]] double Mean(double from, double to) const;

  /// Whether x is strictly increasing and all values are finite.
  [[nodiscard]] bool IsStrictlyIncreasing() const;
};

}  // namespace trackbed
