#include "trackbed/analysis/recovery.h"

#include <algorithm>
#include <cmath>

namespace trackbed {

std::optional<RecoveryMetrics> MeasureRecovery(const RunLog& log, const Disturbances& disturb,
                                               const Wind& wind) {
  const std::optional<double> end = DisturbedUntil(disturb, wind, log.rows.back().state.time);
  if (!end || !log.rows.front().tracking) {
    return std::nullopt;
  }
  RecoveryMetrics recovery{.from = *end, .time = 0.0};
  for (const LogRow& row : log.rows) {
    const bool near = std::abs(row.tracking->cross_track) <= disturb.recovered_within;
    if (!near) {
      recovery.time.reset();
    } else if (!recovery.time) {
      // Round the time to nanoseconds, the resolution of all logged times.
      recovery.time = std::round(std::max(0.0, row.state.time - *end) * 1e9) / 1e9;
    }
  }
  return recovery;
}

}  // namespace trackbed
