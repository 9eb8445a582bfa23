#pragma once

#include "trackbed/analysis/metrics.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Station of a row: on the path, or else the distance driven.
inline double RowStation(const LogRow& row) {
  return row.tracking ? row.tracking->s : row.state.distance;
}

/// Largest magnitude of the lateral acceleration averaged over `window` control periods, including
/// the rows at both ends. A single sample may be an impact of a tyre on the road.
void MeasureLateralAcceleration(const RunLog& log, std::size_t window, PlantMetrics& metrics);

/// Largest magnitude of the measured steering angle, and of its mean rate over `window` control
/// periods.
void MeasureSteering(const RunLog& log, std::size_t window, PlantMetrics& metrics);

/// Fraction of the control periods within `begin` to `end` [s] in which the steering actuator was
/// saturated: at the end of the period it had not reached the command, and it had moved at its
/// maximum rate or was at its maximum angle. A delayed command, or one lost in backlash, is not
/// saturation. If the limits are unknown (0), every miss counts.
double SaturatedFraction(const RunLog& log, const VehicleParams& vehicle, double begin, double end);

}  // namespace trackbed
