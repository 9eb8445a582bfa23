#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/sampling/rrt_star.h"

namespace trackbed {

/// Options of the planner `rrt_star`: RRT* from waypoint to waypoint (rrt_star.h), shortcut where
/// that is not worse, with corners rounded or rejected (corners.h). A leg whose straight line is
/// free is that line, without a tree. Takes the first of several trees whose path the car can
/// drive. More iterations never lengthen a tree's path, but may lengthen or shorten the rounded
/// one. Ignores wind and the headings of waypoints.
struct RrtStarPlannerOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.3;  ///< of the footprint from obstacles [m], >= 0
  double corner_room = 1.0;    ///< additional distance of the trees, for rounded corners [m], >= 0
  double margin = 10.0;        ///< of the sampled area around waypoints and obstacles [m]
  double lead_in = 4.0;        ///< maximum straight stretch at the start [m], >= 0; 0: none
  double min_speed = 0.5;      ///< lowest speed in a corner [m/s]
  int trees = 3;               ///< maximum number, > 0
  int iterations = 5000;       ///< samples for each leg of each tree, >= 0
  /// Maximum length of a new edge [m], > 0; none: a fifth of the sampled area's diagonal.
  std::optional<double> expand_distance{};
  double goal_bias = 0.05;   ///< fraction of samples at the goal until it is reached, 0 to 1
  double corner_cost = 5.0;  ///< of a corner, as path length [m], >= 0
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

/// One of the trees, through all waypoints.
struct RrtStarTreeFindings {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;  ///< empty when ok
};
void Visit(DiagnosticsVisitor& out, const RrtStarTreeFindings& own);

struct RrtStarPlanDiagnostics {
  std::vector<RrtStarLeg> legs;            ///< of the last tree: the chosen one, if any is chosen
  std::vector<RrtStarTreeFindings> trees;  ///< in order of planning
};
void Visit(DiagnosticsVisitor& out, const RrtStarPlanDiagnostics& own);

PlannerEntry RrtStarPlanner();

}  // namespace trackbed
