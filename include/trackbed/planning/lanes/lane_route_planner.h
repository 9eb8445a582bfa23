#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/planning/common/planner.h"
#include "trackbed/road_network/lane_route.h"

/// The planner `lane_route`, which plans paths along the centers of a road network's lanes
/// (road_network/lane_route.h).
namespace trackbed {

struct LaneRouteOptions {
  double min_speed = 0.3;  ///< Lowest speed of the car at a step of curvature [m/s], > 0.
};
void Visit(KeyVisitor& keys, LaneRouteOptions& options);

/// Diagnostics of a plan along the lanes of roads.
struct LaneRouteDiagnostics {
  std::vector<LaneStretch> stretches;
  double deviation = 0.0;  ///< Largest distance of the planned path from the lanes' centers [m].
};
void Visit(DiagnosticsVisitor& out, const LaneStretch& stretch);
void Visit(DiagnosticsVisitor& out, const LaneRouteDiagnostics& own);

/// Returns the planner `lane_route`, which follows PlanRequest::lanes. The planner works in the
/// plane; the heights of the roads (route_ground.h) only affect planned speeds at the car's limit.
/// The plan is rejected if the car starts more than 1 mm or 1 mrad away from the start of the
/// route. The planner `lane_route` ignores obstacles.
PlannerEntry LaneRoutePlanner();

}  // namespace trackbed
