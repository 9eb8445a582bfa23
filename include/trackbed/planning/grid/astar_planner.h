#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/planner.h"

namespace trackbed {

/// A* from waypoint to waypoint (astar.h), its corners rounded or refused (corners.h).
struct AStarOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.3;  ///< of the footprint from obstacles [m], >= 0
  double corner_room = 1.0;    ///< that the search keeps besides, for rounded corners [m], >= 0
  double cell = 0.5;           ///< [m], > 0
  double margin = 10.0;        ///< around waypoints and obstacles [m], within which to look
  double min_speed = 0.5;      ///< no corner is taken more slowly [m/s]
  int budget = 1000000;        ///< cells to look at, for each leg, >= 0
};
void Visit(KeyVisitor& keys, AStarOptions& options);

/// The search from one waypoint to the next.
struct AStarLeg {
  double cost = 0.0;       ///< of its path, see astar.h [m]
  long expansions = 0;     ///< cells that were looked at
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
