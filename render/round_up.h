#pragma once

#include <cmath>

namespace trackbed::render {

/// Rounds a positive `value` up to 1, 2 or 5 times a power of ten, with a tolerance for
/// floating-point errors.
inline double RoundedUp(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= value * (1.0 - 1e-9)) {
      return step * power;
    }
  }
  return 10.0 * power;
}

}  // namespace trackbed::render
