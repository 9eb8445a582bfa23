#pragma once

#include <cstdint>
#include <random>

namespace trackbed {

/// Random numbers that are equal on every machine. The standard fixes the engine but not its
/// distributions, so the mapping to doubles is implemented here.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [low, high).
  double Uniform(double low, double high) {
    constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * kUnit);
  }

  /// Uniform in 0 ... count - 1.
  int Below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace trackbed
