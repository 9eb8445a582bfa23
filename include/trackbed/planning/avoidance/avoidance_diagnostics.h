#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/planning/common/plan_diagnostics.h"
#include "trackbed/planning/sampling/rrt_star.h"

/// Diagnostics of the local planners (avoidance.h), which plan.json contains for each replaced
/// stretch of a path.
namespace trackbed {

/// Result of the safety check in the original code listing (condition Salyga_2), kept for
/// comparison. The safety check measures the distance from the obstacle's corners to a single point
/// of the path, two meters before the obstacle.
struct OnePointCheck {
  double distance = 0.0;  ///< Distance from the checked point to the obstacle's nearest corner [m].
  /// Whether the checked `distance` is at least the safe distance SD plus half the car's width.
  bool passed = false;
};
void Visit(DiagnosticsVisitor& out, const OnePointCheck& check);

/// Diagnostics of the local planner `bezier` for one replaced stretch of the path, stored in
/// AvoidedStretch::method.
struct BezierAvoidanceDiagnostics {
  int curves_tried = 0;
  RrtStarStatus tree_status = RrtStarStatus::kNotReached;
  int tree_iterations = 0;
  std::size_t tree_nodes = 0;
  double tree_cost = 0.0;       ///< Cost of the path that the RRT* tree found, if any [m].
  std::vector<Vec2> tree_path;  ///< Points of the path that the RRT* tree found, if any [m].
  std::string search_method;
  int search_evaluations = 0;
  double search_objective = 0.0;
  OnePointCheck one_point_check;
};
void Visit(DiagnosticsVisitor& out, const BezierAvoidanceDiagnostics& own);

/// Diagnostics of the local planner `listing` for one replaced stretch of the path, stored in
/// AvoidedStretch::method.
struct ListingAvoidanceDiagnostics {
  /// Position of the obstacle on the turn's arc as the method assumes it, in sixths of the arc.
  int obstacle_sixth = 0;
  std::size_t tree_nodes = 0;
  /// Distance from the goal to the nearest node of the search tree [m].
  double goal_distance = 0.0;
  double final_y = 0.0;  ///< Coordinate y of the search tree's final node [m], see turn_maneuver.h.
  OnePointCheck one_point_check;
};
void Visit(DiagnosticsVisitor& out, const ListingAvoidanceDiagnostics& own);

}  // namespace trackbed
