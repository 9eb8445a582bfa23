#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/planner.h"

namespace trackbed {

/// Options of the planner `astar`, which searches for a path from waypoint to waypoint by A*
/// (astar.h), and rounds or rejects the corners of the path (corners.h).
struct AStarOptions {
  Corners corners = Corners::kRound;
  /// Distance that the car's footprint keeps from obstacles [m], >= 0.
  double safe_distance = 0.3;
  /// Additional distance from obstacles during the search, which leaves room for rounding the
  /// corners [m], >= 0.
  double corner_room = 1.0;
  double cell = 0.5;       ///< Side length of a grid cell [m], > 0.
  double margin = 10.0;    ///< Margin of the search area around waypoints and obstacles [m].
  double min_speed = 0.5;  ///< Lowest speed of the car in a rounded corner [m/s].
  int budget = 1000000;  ///< Maximum number of cells that the search may expand on each leg, >= 0.
};
void Visit(KeyVisitor& keys, AStarOptions& options);

/// Diagnostics of the search from one waypoint to the next.
struct AStarLeg {
  /// Cost of the path as defined in astar.h, times the side length of a cell [m].
  double cost = 0.0;
  long expansions = 0;     ///< Number of cells that the search expanded.
  std::size_t cells = 0;   ///< Number of cells of the grid.
  std::vector<Vec2> path;  ///< Corners of the path that the search found on the grid [m].
};
void Visit(DiagnosticsVisitor& out, const AStarLeg& leg);

struct AStarDiagnostics {
  std::vector<AStarLeg> legs;
};
void Visit(DiagnosticsVisitor& out, const AStarDiagnostics& own);

PlannerEntry AStarPlanner();

}  // namespace trackbed
