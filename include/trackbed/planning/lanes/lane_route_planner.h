#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/planning/common/planner.h"
#include "trackbed/road_network/lane_route.h"

/// Plans along the centers of the lanes of a road network (road_network/lane_route.h): the planner
/// `lane_route`.
namespace trackbed {

struct LaneRouteOptions {
  double min_speed = 0.3;  ///< Lowest speed at a step of curvature [m/s], > 0.
};
void Visit(KeyVisitor& keys, LaneRouteOptions& options);

/// Diagnostics of a route over lanes.
struct LaneRouteDiagnostics {
  std::vector<LaneStretch> stretches;
  double deviation = 0.0;  ///< Largest distance of the path from the lanes' centers [m].
};
void Visit(DiagnosticsVisitor& out, const LaneStretch& stretch);
void Visit(DiagnosticsVisitor& out, const LaneRouteDiagnostics& own);

/// Returns the planner `lane_route`, which follows PlanRequest::lanes. The planner works in the
/// plane: heights of roads are part of the ground (route_ground.h), and only affect speeds at the
/// car's limit. The planner rejects a car that starts more than 1 mm or 1 mrad from the start of
/// the route. The planner ignores obstacles.
PlannerEntry LaneRoutePlanner();

}  // namespace trackbed
