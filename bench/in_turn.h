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

/// Does the work once and returns its time [s], without the parts that do not count.
using Timed = std::function<double()>;

/// Compares two implementations of the same work. Each round executes both, in alternating order,
/// so that other load on the machine affects both in the same way. Counters: the medians over the
/// rounds, `ours_s` and `bare_s`; the median and quartiles of the rounds' ratios, `ratio`,
/// `ratio_q1` and `ratio_q3`; and the goal for the ratio, `limit`. The benchmark must be registered
/// with UseManualTime; its time is that of `ours`.
///
/// Returns the median of `ours` [s].
double CompareInTurn(benchmark::State& state, double limit, const Timed& ours, const Timed& bare);

/// Sets the counters of a physics step that takes `seconds` and advances by `timestep` [s]:
/// `step_us`, `step_cycles` at the processor's nominal frequency, and `real_time_factor`.
void CountStep(benchmark::State& state, double seconds, double timestep);

/// Wraps a benchmark so that an exception becomes its error and the other benchmarks still run.
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

/// Registers Guarded(function) under `name`, with the arguments for its call.
template <typename Function, typename... Arguments>
benchmark::internal::Benchmark* RegisterGuarded(const std::string& name, Function function,
                                                Arguments... arguments) {
  return benchmark::RegisterBenchmark(
      name.c_str(), [guarded = Guarded(std::move(function)),
                     arguments...](benchmark::State& state) { guarded(state, arguments...); });
}

}  // namespace trackbed::bench
