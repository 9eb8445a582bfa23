#pragma once

#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/sampling/rrt_star_planner.h"

namespace trackbed {

/// Plans a path through trees of curves (TreeEdges::kCurves): one tree (curve_tree.h) from each
/// stop to the next, unless obstacles block no shorter curve. The poses of the tree's path become
/// the stops of a route of continuous curvature, which is then made faster (FasterRoute). The plan
/// has RrtStarPlanDiagnostics.
Plan PlanCurveTrees(const RrtStarPlannerOptions& options, const PlanRequest& request);

}  // namespace trackbed
