#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace trackbed {

/// Degree to which a condition is satisfied at a sample: its robustness value, and whether the
/// condition holds.
struct Degree {
  static constexpr std::uint32_t kNoRow = std::numeric_limits<std::uint32_t>::max();

  double value = 0.0;
  std::uint32_t row = kNoRow;  ///< index of the sample at which a comparison in the formula has
                               ///< determined `value`
  bool satisfied = false;
};

using Degrees = std::vector<Degree>;

/// Degrees of a condition that always holds (kTrue) and of a condition that never holds (kFalse).
/// Over a time window without samples, the minimum of degrees is kTrue and the maximum is kFalse.
inline constexpr Degree kTrue{.value = std::numeric_limits<double>::infinity(), .satisfied = true};
inline constexpr Degree kFalse{.value = -std::numeric_limits<double>::infinity()};

/// Returns whether the degree of satisfaction a is less than the degree b. Of two degrees with
/// equal robustness values, that of a violated condition is less than that of a satisfied
/// condition. With this order, the minimum of two degrees is satisfied if both degrees are, and the
/// maximum is satisfied if at least one degree is.
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

/// Time windows, one per sample: the window of sample i contains the samples from begin[i] to
/// end[i] (exclusive). The lists `begin` and `end` of sample indices are non-decreasing.
struct Windows {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> end;
};

/// Finds for each sample the window of samples that lie `from` to `to` seconds later, including
/// both ends, with a tolerance of 1 ns. The time window of a sample never begins before the sample
/// itself. The argument `times` (sample times) must be in ascending order.
Windows FindWindows(const std::vector<double>& times, double from, double to);

/// Compute the minimum or maximum over the window of each sample, by Lemire's monotonic wedge
/// algorithm, in a time proportional to the number of samples. If several samples have the same
/// extreme value, SlidingMin and SlidingMax return the earliest of these samples.
Degrees SlidingMin(const Degrees& values, const Windows& windows);
Degrees SlidingMax(const Degrees& values, const Windows& windows);

/// Computes for each sample the degree of "phi until[from, to] psi", in a time proportional to the
/// number of samples (Donzé, Ferrère and Maler 2013). The degree of "phi until psi" at a sample is
/// the minimum of the degrees of three conditions. Condition 1 of "until": psi holds at some sample
/// of the time window. Condition 2 of "until": phi holds from the sample to the beginning of the
/// time window. Condition 3 of "until": "phi until psi" without time bounds holds at the beginning
/// of the time window.
Degrees Until(const Degrees& phi, const Degrees& psi, const Windows& windows);

}  // namespace trackbed
