#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/sampling/rrt_star.h"

namespace trackbed {

/// RRT* from waypoint to waypoint (rrt_star.h), with the points left out that make the path no
/// better, its corners rounded or refused (corners.h). A leg whose straight line is free is that
/// line, without a tree. Of several trees the first whose path the car can drive. More iterations
/// never lengthen a tree's path; the rounded one may change either way. Ignores wind and the
/// headings of waypoints.
struct RrtStarPlannerOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.3;  ///< of the footprint from obstacles [m], >= 0
  double corner_room = 1.0;    ///< that the trees keep besides, for rounded corners [m], >= 0
  double margin = 10.0;        ///< around waypoints and obstacles [m], within which to sample
  double lead_in = 4.0;        ///< straight on from the start, at most [m], >= 0; 0: none
  double min_speed = 0.5;      ///< no corner is taken more slowly [m/s]
  int trees = 3;               ///< tried at most, > 0
  int iterations = 5000;       ///< samples for each leg of each tree, >= 0
  /// Length of an edge when it is made at most [m], > 0; none: a fifth of the sampled area's
  /// diagonal.
  std::optional<double> expand_distance{};
  double goal_bias = 0.05;   ///< share of samples at the goal until it is reached, 0 to 1
  double corner_cost = 5.0;  ///< of a corner, in meters of path [m], >= 0
};
void Visit(KeyVisitor& keys, RrtStarPlannerOptions& options);

/// The tree from one waypoint toward the next.
struct RrtStarLeg {
  RrtStarStatus status = RrtStarStatus::kFound;
  int iterations = 0;          ///< samples; 0 for a straight line
  std::size_t nodes = 0;       ///< of the tree; 2 for a straight line
  std::optional<double> cost;  ///< length of its path [m]; none unless found
  std::vector<Vec2> path;      ///< of the tree [m]; empty unless found
};
void Visit(DiagnosticsVisitor& out, const RrtStarLeg& leg);

/// One of the trees tried, through all waypoints.
struct RrtStarTreeFindings {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;  ///< for people; empty when ok
};
void Visit(DiagnosticsVisitor& out, const RrtStarTreeFindings& own);

struct RrtStarPlanDiagnostics {
  std::vector<RrtStarLeg> legs;            ///< of the last tree tried: the chosen one if any is
  std::vector<RrtStarTreeFindings> trees;  ///< in the order in which they were tried
};
void Visit(DiagnosticsVisitor& out, const RrtStarPlanDiagnostics& own);

PlannerEntry RrtStarPlanner();

}  // namespace trackbed
