#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/planner.h"

namespace trackbed {

/// Options of A* from waypoint to waypoint (astar.h), with corners rounded or rejected (corners.h).
struct AStarOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.3;  ///< of the footprint from obstacles [m], >= 0
  double corner_room = 1.0;    ///< additional distance in the search, for rounded corners [m], >= 0
  double cell = 0.5;           ///< [m], > 0
  double margin = 10.0;        ///< of the search area around waypoints and obstacles [m]
  double min_speed = 0.5;      ///< lowest speed in a corner [m/s]
  int budget = 1000000;        ///< cells to expand on each leg, >= 0
};
void Visit(KeyVisitor& keys, AStarOptions& options);

/// The search from one waypoint to the next.
struct AStarLeg {
  double cost = 0.0;       ///< of its path, see astar.h [m]
  long expansions = 0;     ///< expanded cells
  std::size_t cells = 0;   ///< of the grid
  std::vector<Vec2> path;  ///< corners of the path on the grid [m]
};
void Visit(DiagnosticsVisitor& out, const AStarLeg& leg);

struct AStarDiagnostics {
  std::vector<AStarLeg> legs;
};
void Visit(DiagnosticsVisitor& out, const AStarDiagnostics& own);

PlannerEntry AStarPlanner();

}  // namespace trackbed
