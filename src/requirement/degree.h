#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace trackbed {

/// Robustness of a condition at a sample.
struct Degree {
  static constexpr std::uint32_t kNoRow = std::numeric_limits<std::uint32_t>::max();

  double value = 0.0;
  std::uint32_t row = kNoRow;  ///< the sample whose comparison determines the value
  bool satisfied = false;
};

using Degrees = std::vector<Degree>;

/// Minimum (kTrue) and maximum (kFalse) over no samples.
inline constexpr Degree kTrue{.value = std::numeric_limits<double>::infinity(), .satisfied = true};
inline constexpr Degree kFalse{.value = -std::numeric_limits<double>::infinity()};

/// Of two degrees of equal robustness, the violated one is less. Hence minimum and maximum of
/// degrees are also "and" and "or" of `satisfied`.
inline bool IsLess(const Degree& a, const Degree& b) {
  return a.value != b.value ? a.value < b.value : !a.satisfied && b.satisfied;
}

inline Degree Not(Degree a) {
  return {.value = -a.value, .row = a.row, .satisfied = !a.satisfied};
}
inline Degree Min(const Degree& a, const Degree& b) {
  return IsLess(b, a) ? b : a;
}
inline Degree Max(const Degree& a, const Degree& b) {
  return IsLess(a, b) ? b : a;
}

/// The samples [begin[i], end[i]) of each sample i. Both are non-decreasing.
struct Windows {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> end;
};

/// The samples from `from` to `to` [s] after each sample, both included, to 1 ns; never earlier
/// than the sample itself. `times` must increase.
Windows FindWindows(const std::vector<double>& times, double from, double to);

/// Minimum and maximum over each sample's window, by Lemire's monotonic wedge in O(samples). Of
/// equal extremes, the earliest one.
Degrees SlidingMin(const Degrees& values, const Windows& windows);
Degrees SlidingMax(const Degrees& values, const Windows& windows);

/// phi until[from, to] psi, in O(samples), as "psi within the window, and phi until psi at or after
/// its beginning" (Donzé, Ferrère and Maler 2013).
Degrees Until(const Degrees& phi, const Degrees& psi, const Windows& windows);

}  // namespace trackbed
