#pragma once

#include <optional>

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/disturbances.h"
#include "trackbed/world/wind.h"

namespace trackbed {

/// Recovery of the car after a disturbance.
struct RecoveryMetrics {
  double from = 0.0;  ///< Time at which the last temporary disturbance ends [s].
  /// Time from the end of the disturbance (`from`) until the car stays near its path [s]; nullopt
  /// if the car never stays near the path.
  std::optional<double> time;
};

/// Determines when the car returns to its path and then stays within the distance
/// `disturb.recovered_within`, checked once per control period. Returns nullopt if the run has no
/// path, or if no temporary disturbance ended during the run.
std::optional<RecoveryMetrics> MeasureRecovery(const RunLog& log, const Disturbances& disturb,
                                               const Wind& wind);

}  // namespace trackbed
