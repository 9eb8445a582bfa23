#pragma once

#include <cstdlib>

namespace trackbed {

/// Every tolerance of a test goes through here: the environment variable TRACKBED_TOLERANCE scales
/// them all, and 0 makes each test print its true residual as it fails.
inline double Tolerance(double derived) {
  const char* scale = std::getenv("TRACKBED_TOLERANCE");
  return scale == nullptr ? derived : derived * std::atof(scale);
}

}  // namespace trackbed
