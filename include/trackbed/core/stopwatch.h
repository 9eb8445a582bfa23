#pragma once

#include <chrono>

namespace trackbed {

/// Measures the wall-clock time since construction with a steady clock.
class Stopwatch {
 public:
  /// Returns the wall-clock time since construction [s], >= 0.
  [[nodiscard]] double Seconds() const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace trackbed
