#include "bench/in_turn.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace trackbed::bench {
namespace {

/// The quantile `share` of the values, interpolated linearly.
double Quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - static_cast<double>(below));
}

}  // namespace

double CompareInTurn(benchmark::State& state, double limit, const Timed& ours, const Timed& bare) {
  std::vector<double> ours_s;
  std::vector<double> bare_s;
  bool bare_first = false;
  for ([[maybe_unused]] auto round : state) {
    if (bare_first) {
      bare_s.push_back(bare());
    }
    ours_s.push_back(ours());
    if (!bare_first) {
      bare_s.push_back(bare());
    }
    bare_first = !bare_first;
    state.SetIterationTime(ours_s.back());
  }
  std::vector<double> ratios;
  for (std::size_t i = 0; i < ours_s.size(); ++i) {
    ratios.push_back(ours_s[i] / bare_s[i]);
  }
  const double median = Quantile(ours_s, 0.5);
  state.counters["ours_s"] = median;
  state.counters["bare_s"] = Quantile(bare_s, 0.5);
  state.counters["ratio"] = Quantile(ratios, 0.5);
  state.counters["ratio_q1"] = Quantile(ratios, 0.25);
  state.counters["ratio_q3"] = Quantile(ratios, 0.75);
  state.counters["limit"] = limit;
  return median;
}

void CountStep(benchmark::State& state, double seconds, double timestep) {
  state.counters["step_us"] = 1e6 * seconds;
  state.counters["step_cycles"] = seconds * benchmark::CPUInfo::Get().cycles_per_second;
  state.counters["real_time_factor"] = timestep / seconds;
}

}  // namespace trackbed::bench
