#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace trackbed {

/// Robustness of a condition at a sample.
struct Degree {
  static constexpr std::uint32_t kNoRow = std::numeric_limits<std::uint32_t>::max();

  double value = 0.0;
  std::uint32_t row = kNoRow;  ///< the sample whose comparison decides
  bool satisfied = false;
};

using Degrees = std::vector<Degree>;

/// The minimum over no samples, and the maximum.
inline constexpr Degree kTrue{.value = std::numeric_limits<double>::infinity(), .satisfied = true};
inline constexpr Degree kFalse{.value = -std::numeric_limits<double>::infinity()};

/// Of equal robustness, a violated condition is less: so minimum and maximum of degrees are also
/// "and" and "or" of whether they are satisfied.
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

/// The samples [begin[i], end[i]) of each sample i. Neither decreases with i.
struct Windows {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> end;
};

/// The samples from `from` to `to` [s] after each, both included, to 1 ns; none before itself.
/// `times` increase.
Windows FindWindows(const std::vector<double>& times, double from, double to);

/// Minimum and maximum over the window of each sample, the earliest of equal ones, by Lemire's
/// monotonic wedge in O(samples).
Degrees SlidingMin(const Degrees& values, const Windows& windows);
Degrees SlidingMax(const Degrees& values, const Windows& windows);

/// phi until[from, to] psi, in O(samples): "psi within the window, and phi until psi at or after
/// its begin" (Donzé, Ferrère and Maler 2013).
Degrees Until(const Degrees& phi, const Degrees& psi, const Windows& windows);

}  // namespace trackbed
