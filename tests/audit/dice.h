#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

namespace audit {

/// Draws random numbers that are the same with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  double Between(double low, double high) {
    const double share = static_cast<double>(engine_() >> 11U) * 0x1.0p-53;
    return low + (high - low) * share;
  }
  double Logarithmic(double low, double high) {
    return std::exp(Between(std::log(low), std::log(high)));
  }
  bool Chance(double probability) { return Between(0.0, 1.0) < probability; }
  std::size_t Below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  template <typename T, std::size_t N>
  T Choose(const std::array<T, N>& values) {
    return values[Below(N)];
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace audit
