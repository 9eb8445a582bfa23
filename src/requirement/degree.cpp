#include "src/requirement/degree.h"

#include <algorithm>
#include <deque>

namespace trackbed {
namespace {

constexpr double kTimeTolerance = 1e-9;  // [s]

/// Returns for each sample the minimum or the maximum of the values in the sample's window. The
/// strict order `precedes` determines whether the minimum or the maximum is computed.
template <typename Precedes>
Degrees SlidingExtreme(const Degrees& values, const Windows& windows, const Degree& of_none,
                       const Precedes& precedes) {
  Degrees extremes(values.size());
  // Indices of the samples in the time window whose values are more extreme than those of all later
  // samples in the window.
  std::deque<std::uint32_t> wedge;
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (; next < windows.end[i]; ++next) {
      while (!wedge.empty() && precedes(values[next], values[wedge.back()])) {
        wedge.pop_back();
      }
      wedge.push_back(next);
    }
    while (!wedge.empty() && wedge.front() < windows.begin[i]) {
      wedge.pop_front();
    }
    extremes[i] = wedge.empty() ? of_none : values[wedge.front()];
  }
  return extremes;
}

}  // namespace

Windows FindWindows(const std::vector<double>& times, double from, double to) {
  const auto count = static_cast<std::uint32_t>(times.size());
  Windows windows{std::vector<std::uint32_t>(count), std::vector<std::uint32_t>(count)};
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    begin = std::max(begin, i);
    while (begin < count && times[begin] < times[i] + from - kTimeTolerance) {
      ++begin;
    }
    end = std::max(end, begin);
    while (end < count && times[end] <= times[i] + to + kTimeTolerance) {
      ++end;
    }
    windows.begin[i] = begin;
    windows.end[i] = end;
  }
  return windows;
}

Degrees SlidingMin(const Degrees& values, const Windows& windows) {
  return SlidingExtreme(values, windows, kTrue, IsLess);
}

Degrees SlidingMax(const Degrees& values, const Windows& windows) {
  return SlidingExtreme(values, windows, kFalse,
                        [](const Degree& a, const Degree& b) { return IsLess(b, a); });
}

Degrees Until(const Degrees& phi, const Degrees& psi, const Windows& windows) {
  const std::size_t count = phi.size();
  // Degrees of the formula `phi until psi` without time bounds, one per sample.
  Degrees from_here(count + 1, kFalse);
  Windows before{std::vector<std::uint32_t>(count), windows.begin};
  for (std::size_t i = count; i-- > 0;) {
    from_here[i] = Max(psi[i], Min(phi[i], from_here[i + 1]));
    before.begin[i] = static_cast<std::uint32_t>(i);
  }
  const Degrees meanwhile = SlidingMin(phi, before);
  Degrees until = SlidingMax(psi, windows);
  for (std::size_t i = 0; i < count; ++i) {
    until[i] = Min(until[i], Min(meanwhile[i], from_here[windows.begin[i]]));
  }
  return until;
}

}  // namespace trackbed
