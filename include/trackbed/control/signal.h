#pragma once

#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// A quantity given at some points: linear between knots (x, value), constant before the first and
/// after the last. x is strictly increasing. Evaluating a signal without knots is an InternalError.
struct Signal {
  std::vector<Vec2> knots;

  [[nodiscard]] bool empty() const { return knots.empty(); }

  /// Exact at the knots. Cost O(log knots).
  [[nodiscard]] double At(double x) const;

  /// Mean over [from, to], exact to rounding; the value at `from` if to <= from. Cost O(log knots +
  /// knots between).
  [[nodiscard]] double Mean(double from, double to) const;

  /// Whether x is strictly increasing and all values are finite.
  [[nodiscard]] bool IsStrictlyIncreasing() const;
};

}  // namespace trackbed
