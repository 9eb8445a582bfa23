#pragma once

#include <optional>

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/disturbances.h"
#include "trackbed/world/wind.h"

namespace trackbed {

/// Recovery of a run after a disturbance.
struct RecoveryMetrics {
  double from = 0.0;           ///< end of the last temporary disturbance [s]
  std::optional<double> time;  ///< from then until the car stays near its path [s]; none: never
};

/// A car is near its path within `disturb.recovered_within`, checked once per control period. None
/// without a path, or if no temporary disturbance ended during the run.
std::optional<RecoveryMetrics> MeasureRecovery(const RunLog& log, const Disturbances& disturb,
                                               const Wind& wind);

}  // namespace trackbed
