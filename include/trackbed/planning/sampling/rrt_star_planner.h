#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/sampling/rrt_star.h"

namespace trackbed {

/// Options of the planner `rrt_star`. The planner grows trees from waypoint to waypoint by RRT*
/// (rrt_star.h), takes shortcuts that do not worsen the path, and rounds or rejects corners
/// (corners.h). If the straight line to the next waypoint is free, the path follows that line,
/// without a tree. The result is the path of the first tree whose path the car can drive. More
/// iterations never lengthen the path of a tree, but may lengthen or shorten the rounded path. The
/// planner ignores wind and the headings of waypoints.
struct RrtStarPlannerOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.3;  ///< Distance of the footprint from obstacles [m], >= 0.
  /// Additional distance of the trees from obstacles, which leaves room for rounded corners [m], >=
  /// 0.
  double corner_room = 1.0;
  double margin = 10.0;  ///< Margin of the sampled area around waypoints and obstacles [m].
  double lead_in = 4.0;  ///< Maximum length of a straight stretch at the start [m], >= 0; 0: none.
  double min_speed = 0.5;  ///< Lowest speed in a corner [m/s].
  int trees = 3;           ///< Maximum number of trees, > 0.
  int iterations = 5000;   ///< Number of samples for each leg of each tree, >= 0.
  /// Maximum length of a new edge [m], > 0; none: a fifth of the sampled area's diagonal.
  std::optional<double> expand_distance{};
  double goal_bias = 0.05;   ///< Fraction of samples at the goal until the goal is reached, 0 to 1.
  double corner_cost = 5.0;  ///< Cost of a corner, as path length [m], >= 0.
};
void Visit(KeyVisitor& keys, RrtStarPlannerOptions& options);

/// The tree from one waypoint toward the next.
struct RrtStarLeg {
  RrtStarStatus status = RrtStarStatus::kFound;
  int iterations = 0;          ///< Number of samples; 0 for a straight line.
  std::size_t nodes = 0;       ///< Number of nodes of the tree; 2 for a straight line.
  std::optional<double> cost;  ///< Length of the leg's path [m]; none unless found.
  std::vector<Vec2> path;      ///< Path of the tree [m]; empty unless found.
};
void Visit(DiagnosticsVisitor& out, const RrtStarLeg& leg);

/// Findings on one of the trees through all waypoints.
struct RrtStarTreeFindings {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;  ///< Reason of a failure; empty if ok.
};
void Visit(DiagnosticsVisitor& out, const RrtStarTreeFindings& own);

struct RrtStarPlanDiagnostics {
  /// Legs of the last tree, which is the chosen tree if any tree is chosen.
  std::vector<RrtStarLeg> legs;
  std::vector<RrtStarTreeFindings> trees;  ///< Findings on the trees, in order of planning.
};
void Visit(DiagnosticsVisitor& out, const RrtStarPlanDiagnostics& own);

PlannerEntry RrtStarPlanner();

}  // namespace trackbed
