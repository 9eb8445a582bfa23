#pragma once

#include "trackbed/analysis/metrics.h"

namespace trackbed {

/// Where a row is along the way: the path's station, or the distance driven.
inline double RowStation(const LogRow& row) {
  return row.tracking ? row.tracking->s : row.state.distance;
}

/// The largest magnitude of the lateral acceleration's mean over `window` periods of control, the
/// rows at both ends among them. A single sample may be that of an impact of a tyre on the road.
void MeasureLateralAcceleration(const RunLog& log, std::size_t window, PlantMetrics& metrics);

/// The largest magnitude of the measured steering angle, and of its mean rate over `window` periods
/// of control.
void MeasureSteering(const RunLog& log, std::size_t window, PlantMetrics& metrics);

}  // namespace trackbed
