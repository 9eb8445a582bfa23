#pragma once

#include <optional>

#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/disturbances.h"
#include "trackbed/world/wind.h"

namespace trackbed {

/// How a drive got back to its path after what had thrown it off.
struct RecoveryMetrics {
  double from = 0.0;           ///< when the last disturbance was over that comes and goes [s]
  std::optional<double> time;  ///< from then until it is near its path for good [s]; none: never
};

/// Near its path is a car within `disturb.recovered_within`; looked at once per control period.
/// None without a path, or when nothing that comes and goes was over before the drive was.
std::optional<RecoveryMetrics> MeasureRecovery(const RunLog& log, const Disturbances& disturb,
                                               const Wind& wind);

}  // namespace trackbed
