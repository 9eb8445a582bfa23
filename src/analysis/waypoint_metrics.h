#pragma once

#include <optional>

#include "trackbed/analysis/metrics.h"

namespace trackbed {

/// Measures how far the plan and the driven path pass from the waypoints of the plan. The driven
/// path is the polyline through the rear axle's positions in the log, up to the first contact with
/// an obstacle. MeasureWaypointMiss returns nullopt if the plan has no waypoints.
std::optional<WaypointMissMetrics> MeasureWaypointMiss(const RunLog& log, const Plan& plan);

}  // namespace trackbed
