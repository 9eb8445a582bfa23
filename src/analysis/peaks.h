#pragma once

#include "trackbed/analysis/metrics.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Station of a row on the path; without a path, the distance driven.
inline double RowStation(const LogRow& row) {
  return row.tracking ? row.tracking->s : row.state.distance;
}

/// Largest magnitude of the lateral acceleration averaged over `window` control periods. The
/// average of the acceleration includes the rows at both ends of the window. The acceleration is
/// averaged, since a single sample may be an impact of a tyre on the road.
void MeasureLateralAcceleration(const RunLog& log, std::size_t window, PlantMetrics& metrics);

/// Measures the largest magnitude of the measured steering angle, and of its mean rate over
/// `window` control periods.
void MeasureSteering(const RunLog& log, std::size_t window, PlantMetrics& metrics);

/// Fraction of the control periods within `begin` to `end` [s] in which the steering actuator was
/// saturated. A saturated actuator does not reach the command although it moves at its maximum rate
/// or is at its maximum angle. Delay and backlash of the command are not saturation. If the limits
/// are unknown (0), every period in which the actuator misses the command counts.
double SaturatedFraction(const RunLog& log, const VehicleParams& vehicle, double begin, double end);

}  // namespace trackbed
