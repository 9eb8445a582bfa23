#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/planner.h"

namespace trackbed {

/// Options of the planner that searches from waypoint to waypoint by A* (astar.h), and rounds or
/// rejects corners (corners.h).
struct AStarOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.3;  ///< Distance of the footprint from obstacles [m], >= 0.
  /// Additional distance from obstacles in the search, which leaves room for rounded corners [m],
  /// >= 0.
  double corner_room = 1.0;
  double cell = 0.5;       ///< Side of a cell [m], > 0.
  double margin = 10.0;    ///< Margin of the search area around waypoints and obstacles [m].
  double min_speed = 0.5;  ///< Lowest speed in a corner [m/s].
  int budget = 1000000;    ///< Maximum number of expanded cells on each leg, >= 0.
};
void Visit(KeyVisitor& keys, AStarOptions& options);

/// The search from one waypoint to the next.
struct AStarLeg {
  double cost = 0.0;       ///< Cost of the path, see astar.h [m].
  long expansions = 0;     ///< Number of expanded cells.
  std::size_t cells = 0;   ///< Number of cells of the grid.
  std::vector<Vec2> path;  ///< Corners of the path on the grid [m].
};
void Visit(DiagnosticsVisitor& out, const AStarLeg& leg);

struct AStarDiagnostics {
  std::vector<AStarLeg> legs;
};
void Visit(DiagnosticsVisitor& out, const AStarDiagnostics& own);

PlannerEntry AStarPlanner();

}  // namespace trackbed
