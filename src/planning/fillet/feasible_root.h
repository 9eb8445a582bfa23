#pragma once

#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>

namespace trackbed {

/// Finds the root of f in [a, b] and returns a point next to the root at which f <= 0. The function
/// f must have different signs at a and b.
template <typename Function>
double FeasibleRoot(const Function& f, double a, double b) {
  std::uintmax_t iterations = 200;
  const auto [low, high] = boost::math::tools::toms748_solve(
      f, a, b, boost::math::tools::eps_tolerance<double>(52), iterations);
  return f(high) <= 0.0 ? high : low;
}

}  // namespace trackbed
