#pragma once

#include <benchmark/benchmark.h>

#include <chrono>
#include <functional>

namespace trackbed::bench {

class Stopwatch {
 public:
  [[nodiscard]] double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Does the work once and gives back how long it took [s]: what is not to count is left out there.
using Timed = std::function<double()>;

/// Compares two ways of doing the same work: each round does both, each first every other time, so
/// that whatever else the machine does falls on both alike. Counters are the medians `ours_s` and
/// `bare_s`, their `ratio`, and the `limit` that it is meant to keep. The benchmark must be
/// registered with UseManualTime; its time is that of `ours`.
///
/// Returns the median of `ours` [s].
double CompareInTurn(benchmark::State& state, double limit, const Timed& ours, const Timed& bare);

}  // namespace trackbed::bench
