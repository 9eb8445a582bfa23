#pragma once

#include "src/planning/curves/continuous_route.h"
#include "src/planning/curves/fastest_leg.h"

namespace trackbed {

/// Returns a plan whose path of continuous curvature is driven in less time, or the plan itself.
///
/// A numerical search (fastest_leg.h) changes each leg between its waypoints and cusps. A changed
/// leg is used if it is free of obstacles and feasible, and if the whole route takes less time.
/// Poses and curvatures at waypoints and cusps stay unchanged. The path passes waypoints that the
/// plan leaves out within a quarter of the car's width (WithoutDetours). A plan stays unchanged if
/// its curvature steps between cusps, if its objective is not CurveObjective::kTime, or if its
/// speeds are at the car's limit. The diagnostics of the plan are CurveDiagnostics.
/// `legs` keeps the solutions for further routes.
Plan FasterRoute(const ContinuousRoute& route, const PlanRequest& request, Plan plan,
                 FasterLegs& legs);

}  // namespace trackbed
