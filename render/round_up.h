#pragma once

#include <cmath>

namespace trackbed::render {

/// The least of 1, 2 and 5 times a power of ten that is not less than `value` > 0, but for
/// rounding.
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
