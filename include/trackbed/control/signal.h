#pragma once

#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// A quantity known at some points: linear between knots (x, value), held before the first and
/// after the last. x rises strictly. Without knots it has no
/// values: to ask for one is an InternalError.
struct Signal {
  std::vector<Vec2> knots;

  [[nodiscard]] bool empty() const { return knots.empty(); }

  /// Exact at the knots. Cost O(log knots).
  [[nodiscard]] double At(double x) const;

  /// Mean over [from, to], exact to rounding; the value at `from` unless `to` lies beyond it. Cost
  /// O(log knots + knots between).
  [[nodiscard]] double Mean(double from, double to) const;

  /// Whether x rises strictly and everything is finite.
  [[nodiscard]] bool IsStrictlyIncreasing() const;
};

}  // namespace trackbed
