#pragma once

#include "src/planning/curves/continuous_route.h"

namespace trackbed {

/// Returns a plan whose path of continuous curvature is driven in less time, or the plan itself.
///
/// Each leg is changed between its waypoints and cusps by a numerical search (fastest_leg.h), if it
/// stays free of obstacles and feasible, and the whole route takes less time. Poses and curvatures
/// at waypoints and cusps remain. A plan whose curvature steps between cusps, or whose objective is
/// not CurveObjective::kTime, or with speeds at the car's limit, remains. The diagnostics of the
/// plan are CurveDiagnostics.
Plan FasterRoute(const ContinuousRoute& route, const PlanRequest& request, Plan plan);

}  // namespace trackbed
