#pragma once

#include "trackbed/analysis/metrics.h"
#include "trackbed/vehicle/params.h"

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

/// The share of the control periods within `begin` to `end` [s] in which a limit of the steering
/// actuator was reached: at their end it had not reached the command, and it had turned at its full
/// rate or stood at its largest angle. A command that is delayed, or lost in a backlash, is no
/// limit. Of a vehicle whose limits are not known (0), every miss counts.
double SaturatedFraction(const RunLog& log, const VehicleParams& vehicle, double begin, double end);

}  // namespace trackbed
