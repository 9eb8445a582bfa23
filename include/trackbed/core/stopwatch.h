#pragma once

#include <chrono>

namespace trackbed {

/// Wall-clock time since construction, by a steady clock.
class Stopwatch {
 public:
  /// Elapsed time [s], >= 0.
  [[nodiscard]] double Seconds() const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace trackbed
