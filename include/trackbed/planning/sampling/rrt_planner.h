#pragma once

#include <optional>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/sampling/rrt_diagnostics.h"

namespace trackbed {

/// Options of the planner `rrt`. The planner `rrt` grows trees from waypoint to waypoint by RRT
/// (rrt.h), and smooths the resulting paths with regard to wind (smoothing.h). The planner takes
/// shortcuts that do not worsen the score of a path, and rounds or rejects corners (corners.h).
/// Among the paths that the car can drive, the planner chooses the path with the best score
/// (comparator.h). If no tree reaches the goal and partial paths are allowed (Plan::partial), the
/// result is the path that ends nearest to the first unreached waypoint. A partial path ends at the
/// tree's node that is nearest to the unreached waypoint. If the car's front is too near to an
/// obstacle at the end of a partial path, the path is shortened to the last node at which the car
/// is clear.
struct RrtPlannerOptions {
  Corners corners = Corners::kRound;
  /// Distance that the car's footprint keeps from obstacles [m], >= 0.
  double safe_distance = 0.3;
  /// Additional distance of the trees from obstacles, which leaves room for rounding the corners
  /// [m], >= 0.
  double corner_room = 1.0;
  double margin = 10.0;  ///< Margin of the sampled area around waypoints and obstacles [m].
  /// Maximum length of a straight start of the path [m], >= 0; 0: no straight start.
  double lead_in = 4.0;
  double min_speed = 0.5;  ///< Lowest speed of the car in a rounded corner [m/s].
  int trees = 10;          ///< Number of search trees that the planner grows, > 0.
  int iterations = 10000;  ///< Maximum number of random samples for each leg of each tree, >= 0.
  double expand_distance = 2.0;  ///< Maximum length of a tree's edge [m], > 0.
  double goal_bias = 0.05;       ///< Fraction of the samples that are placed at the goal, 0 to 1.
  double data_weight = 0.1;      ///< Weight alpha of the original points in smoothing.
  /// Weight beta of smoothness in smoothing; 0 < alpha + 2 beta < 1, with the weight alpha of the
  /// original points.
  double smoothness_weight = 0.4;
  double corner_cost = 5.0;  ///< Cost of a corner, as an additional path length [m], >= 0.
  double wind_weight = 1.0;  ///< Weight k_w of the wind relative to the path length, >= 0.
  /// Time limit for growing trees, measured by PlanRequest::clock [s], > 0; nullopt: no limit.
  /// Smoothing the path and rounding its corners take time beyond the time limit.
  std::optional<double> time_limit{};
  /// Whether partial paths are allowed. If `partial` is nullopt, partial paths are allowed only
  /// with a time limit.
  std::optional<bool> partial{};
};
void Visit(KeyVisitor& keys, RrtPlannerOptions& options);

PlannerEntry RrtPlanner();

}  // namespace trackbed
