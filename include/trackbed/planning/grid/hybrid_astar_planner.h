#pragma once

#include <vector>

#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/grid/hybrid_astar.h"

namespace trackbed {

/// Diagnostics of the search from one stop to the next.
struct HybridAStarLeg {
  double cost = 0.0;   ///< Cost of the path [m].
  int expansions = 0;  ///< Number of poses that all searches expanded.
  int cells = 0;       ///< Number of position cells of the search area.
};
void Visit(DiagnosticsVisitor& out, const HybridAStarLeg& leg);

struct HybridAStarDiagnostics {
  std::vector<HybridAStarLeg> legs;
};
void Visit(DiagnosticsVisitor& out, const HybridAStarDiagnostics& own);

/// Returns the planner `hybrid_astar`.
PlannerEntry HybridAStarPlanner();

}  // namespace trackbed
