#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace trackbed {

/// Robustness of a condition at a sample.
struct Degree {
  static constexpr std::uint32_t kNoRow = std::numeric_limits<std::uint32_t>::max();

  double value = 0.0;
  std::uint32_t row = kNoRow;  ///< sample whose comparison determines the value
  bool satisfied = false;
};

using Degrees = std::vector<Degree>;

/// The minimum over an empty set of samples is kTrue, and the maximum is kFalse.
inline constexpr Degree kTrue{.value = std::numeric_limits<double>::infinity(), .satisfied = true};
inline constexpr Degree kFalse{.value = -std::numeric_limits<double>::infinity()};

/// Whether a degree is less than another degree. Of two degrees of equal robustness, the violated
/// degree is less. Hence the minimum of degrees is also the "and" of `satisfied`, and the maximum
/// is the "or".
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

/// The samples [begin[i], end[i]) of each sample i. The lists `begin` and `end` are non-decreasing.
struct Windows {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> end;
};

/// The samples from `from` to `to` [s] after each sample, both included, to 1 ns. A window never
/// begins before its sample. `times` must increase.
Windows FindWindows(const std::vector<double>& times, double from, double to);

/// Minimum and maximum over each sample's window, by Lemire's monotonic wedge in O(samples). If
/// several samples have the same extreme value, the functions return the earliest sample.
Degrees SlidingMin(const Degrees& values, const Windows& windows);
Degrees SlidingMax(const Degrees& values, const Windows& windows);

/// Degrees of phi until[from, to] psi, in O(samples) (Donzé, Ferrère and Maler 2013). The function
/// evaluates "psi within the window, and phi until psi at or after its beginning".
Degrees Until(const Degrees& phi, const Degrees& psi, const Windows& windows);

}  // namespace trackbed
