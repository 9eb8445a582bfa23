#pragma once

#include <cstdlib>

namespace trackbed {

/// Scales a test's tolerance by the environment variable TRACKBED_TOLERANCE; every tolerance uses
/// this function. With 0, each test fails and prints its actual residual.
inline double Tolerance(double derived) {
  const char* scale = std::getenv("TRACKBED_TOLERANCE");
  return scale == nullptr ? derived : derived * std::atof(scale);
}

}  // namespace trackbed
