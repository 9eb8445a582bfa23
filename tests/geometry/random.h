#pragma once

#include <cstdint>
#include <random>

namespace trackbed {

/// Generates random numbers that are equal on every machine. The C++ standard defines the output of
/// the engine, but not that of its distributions. Therefore this class converts the numbers itself.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Returns a number from a uniform distribution over [low, high).
  double Uniform(double low, double high) {
    constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * kUnit);
  }

  /// Returns an integer from 0 to count - 1, all equally probable.
  int Below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace trackbed
