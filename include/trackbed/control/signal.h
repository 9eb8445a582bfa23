#pragma once

#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// A piecewise linear function of x, given by knots (x, value). A signal is constant before its
/// first knot and after its last knot. The x values of the signal's knots are strictly increasing.
/// Evaluating a signal without knots throws InternalError.
struct Signal {
  std::vector<Vec2> knots;

  [[nodiscard]] bool empty() const { return knots.empty(); }

  /// Returns the signal's value at x, which at a knot is exactly the knot's value. Cost: O(log n)
  /// for n knots.
  [[nodiscard]] double At(double x) const;

  /// Returns the signal's mean over the interval [from, to], exact except for rounding errors. If
  /// to <= from, returns the signal's value at `from`. Cost: O(log n + m) for n knots, of which m
  /// lie in the interval.
  [[nodiscard]] double Mean(double from, double to) const;

  /// Returns whether the x values of the knots are strictly increasing and all values are finite.
  [[nodiscard]] bool IsStrictlyIncreasing() const;
};

}  // namespace trackbed
