#include "bench/in_turn.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace trackbed::bench {
namespace {

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
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
  const double median = Median(ours_s);
  state.counters["ours_s"] = median;
  state.counters["bare_s"] = Median(bare_s);
  state.counters["ratio"] = median / Median(bare_s);
  state.counters["limit"] = limit;
  return median;
}

}  // namespace trackbed::bench
