#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/sampling/rrt_star.h"

namespace trackbed {

/// The edges of the trees of `rrt_star`.
enum class TreeEdges {
  kLines,  ///< Straight lines between points; the corners of the path are rounded afterwards.
  /// Forward curves of continuous curvature (continuous_curvature.h) between poses with straight
  /// wheels. The cost of an edge is its driving time, for the best of a few speeds on its turns.
  kCurves,
};

/// Options of the planner `rrt_star`. The planner `rrt_star` grows trees from waypoint to waypoint
/// by RRT* (rrt_star.h), takes shortcuts that do not worsen the path, and rounds or rejects corners
/// (corners.h). Where the straight line to the next waypoint is free, the path follows this line,
/// and no tree is grown. The planned path is that of the first tree whose path the car can drive.
/// More iterations never increase the cost of a tree's path, but may lengthen or shorten the final
/// path. The planner `rrt_star` ignores wind.
///
/// With TreeEdges::kLines, the cost is the length. `rrt_star` then ignores the headings of
/// waypoints, `max_lateral_acceleration` and `max_steering_rate_fraction`.
///
/// With TreeEdges::kCurves, the cost is the driving time, and the path has no corners: each tree is
/// rewired by curves that the wheels can follow, and every curve keeps `safe_distance` from
/// obstacles. `corners`, `corner_room`, `corner_cost`, `lead_in` and `goal_bias` have no effect. A
/// sampled pose counts as 400 samples of PlanRequest::max_samples, because it takes up to 10 ms.
struct RrtStarPlannerOptions {
  TreeEdges edges = TreeEdges::kLines;
  Corners corners = Corners::kRound;
  /// Distance that the car's footprint keeps from obstacles [m], >= 0.
  double safe_distance = 0.3;
  /// Additional distance of the trees from obstacles, which leaves room for rounding the corners
  /// [m], >= 0.
  double corner_room = 1.0;
  double margin = 10.0;  ///< Margin of the sampled area around waypoints and obstacles [m].
  /// Maximum length of a straight start of the path [m], >= 0; 0: no straight start.
  double lead_in = 4.0;
  double min_speed = 0.5;  ///< Lowest speed of the car in a rounded corner, or on turns [m/s].
  int trees = 3;           ///< Maximum number of search trees that the planner grows, > 0.
  int iterations = 5000;   ///< Number of random samples for each leg of each tree, >= 0.
  /// Maximum length of a new edge of a tree [m], > 0; none: a fifth of the sampled area's diagonal.
  std::optional<double> expand_distance{};
  /// Fraction of the samples that are placed at the goal until the goal is reached, 0 to 1.
  double goal_bias = 0.05;
  double corner_cost = 5.0;  ///< Cost of a corner, as an additional path length [m], >= 0.
  /// Largest lateral acceleration on curves [m/s^2], > 0; half of the tyres' grip is another limit.
  double max_lateral_acceleration = 3.0;
  /// Fraction of the car's steering rate that curves use, in (0, 1].
  double max_steering_rate_fraction = 0.9;
};
void Visit(KeyVisitor& keys, RrtStarPlannerOptions& options);

/// Diagnostics of the tree that grows from one waypoint toward the next.
struct RrtStarLeg {
  RrtStarStatus status = RrtStarStatus::kFound;
  int iterations = 0;     ///< Number of random samples; 0 if the path is a straight line.
  std::size_t nodes = 0;  ///< Number of nodes of the tree; 2 if the path is a straight line.
  /// Length of the path on this leg [m]; none unless a path was found.
  std::optional<double> cost;
  std::vector<Vec2> path;  ///< Points of the path in the tree [m]; empty unless a path was found.
};
void Visit(DiagnosticsVisitor& out, const RrtStarLeg& leg);

/// Status of one search tree that leads through all waypoints.
struct RrtStarTreeFindings {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;  ///< Reason why no path was found; empty if ok.
};
void Visit(DiagnosticsVisitor& out, const RrtStarTreeFindings& own);

struct RrtStarPlanDiagnostics {
  /// Diagnostics of the last search tree, for each leg of the route; if a tree was chosen, the last
  /// tree is the chosen one.
  std::vector<RrtStarLeg> legs;
  std::vector<RrtStarTreeFindings> trees;  ///< Status of each tree, in order of planning.
};
void Visit(DiagnosticsVisitor& out, const RrtStarPlanDiagnostics& own);

PlannerEntry RrtStarPlanner();

}  // namespace trackbed
