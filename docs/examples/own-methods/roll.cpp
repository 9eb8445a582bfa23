#include <trackbed/analysis/metric_registry.h>

#include <cmath>

using namespace trackbed;

/// Returns the roll angle with the largest magnitude [rad], with its station and time.
std::optional<MetricReading> LargestRoll(const MetricInput& input) {
  MetricReading reading{0.0, {.span = MetricSpan::kMoment}};
  double largest = 0.0;
  for (const LogRow& row : input.log.rows) {
    if (std::abs(row.state.roll) > largest) {
      largest = std::abs(row.state.roll);
      reading = {largest,
                 {.span = MetricSpan::kMoment, .s = row.state.distance, .t = row.state.time}};
    }
  }
  return reading;
}

MetricEntry RollMax() {
  return {.path = "roll_max",
          .label = "Largest roll angle",
          .unit = "rad",
          .measure = LargestRoll,
          .located = true};
}
