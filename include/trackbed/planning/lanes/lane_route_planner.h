#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/planning/common/planner.h"
#include "trackbed/road_network/lane_route.h"

/// The planner `lane_route`: along the lanes' centers of a road network
/// (road_network/lane_route.h).
namespace trackbed {

struct LaneRouteOptions {
  double min_speed = 0.3;  ///< no step of curvature is taken more slowly [m/s], > 0
};
void Visit(KeyVisitor& keys, LaneRouteOptions& options);

/// The route as found.
struct LaneRouteDiagnostics {
  std::vector<LaneStretch> stretches;
  double deviation = 0.0;  ///< largest distance of the path from the lanes' centers [m]
};
void Visit(DiagnosticsVisitor& out, const LaneStretch& stretch);
void Visit(DiagnosticsVisitor& out, const LaneRouteDiagnostics& own);

/// Plans PlanRequest::lanes in the plane: the heights of roads are ground (route_ground.h), which
/// counts for speeds at the limit alone. Refuses a car that starts more than 1 mm or 1 mrad from
/// where the route begins. Does not look at obstacles.
PlannerEntry LaneRoutePlanner();

}  // namespace trackbed
