#pragma once

#include "trackbed/analysis/metrics.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Returns the station of a log row on the path; without a path, returns the distance driven.
inline double RowStation(const LogRow& row) {
  return row.tracking ? row.tracking->s : row.state.distance;
}

/// Measures the largest magnitude of the lateral acceleration after averaging over `window` control
/// periods. Each average includes the rows at both ends of the averaging window. The acceleration
/// is averaged, because a single sample may contain the impact of a tyre on the road.
void MeasureLateralAcceleration(const RunLog& log, std::size_t window, PlantMetrics& metrics);

/// Measures the largest magnitude of the steering angle, and the largest magnitude of the steering
/// rate after averaging over `window` control periods.
void MeasureSteering(const RunLog& log, std::size_t window, PlantMetrics& metrics);

/// Returns the fraction of the control periods from `begin` to `end` [s] in which the steering
/// actuator was saturated, in [0, 1]. A saturated actuator turns at its maximum rate during the
/// whole period, or is at its maximum angle at the end of the period. The actuator counts as being
/// at a limit if it reaches 99.9 % of the limit. Saturation is judged by the motion of the
/// actuator, not by the command, because some controllers only command angles within the actuator's
/// limits. An unknown limit of the actuator (0) counts as never reached.
double SaturatedFraction(const RunLog& log, const VehicleParams& vehicle, double begin, double end);

}  // namespace trackbed
