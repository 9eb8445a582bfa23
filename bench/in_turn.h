#pragma once

#include <benchmark/benchmark.h>

#include <chrono>
#include <exception>
#include <functional>
#include <string>
#include <utility>

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
/// `bare_s` over the rounds, of the rounds' ratios the median and the quartiles (`ratio`,
/// `ratio_q1` and `ratio_q3`), and the `limit` that the ratio is meant to keep. The benchmark must
/// be registered with UseManualTime; its time is that of `ours`.
///
/// Returns the median of `ours` [s].
double CompareInTurn(benchmark::State& state, double limit, const Timed& ours, const Timed& bare);

/// Counters of a physics step that takes `seconds` and advances by `timestep` [s]: its `step_us`,
/// `step_cycles` at the processor's nominal frequency, and the `real_time_factor`.
void CountStep(benchmark::State& state, double seconds, double timestep);

/// A benchmark that reports an exception as its error, so that the others go on.
template <typename Function>
auto Guarded(Function function) {
  return [function = std::move(function)](benchmark::State& state, auto&&... arguments) {
    try {
      function(state, arguments...);
    } catch (const std::exception& error) {
      state.SkipWithError(error.what());
    }
  };
}

/// Registers Guarded(function) under the name, with the arguments that it is to be called with.
template <typename Function, typename... Arguments>
benchmark::internal::Benchmark* RegisterGuarded(const std::string& name, Function function,
                                                Arguments... arguments) {
  return benchmark::RegisterBenchmark(
      name.c_str(), [guarded = Guarded(std::move(function)),
                     arguments...](benchmark::State& state) { guarded(state, arguments...); });
}

}  // namespace trackbed::bench
