#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/sampling/comparator.h"
#include "trackbed/planning/sampling/rrt.h"

namespace trackbed {

/// Options of the planner `rrt`. The planner `rrt` grows trees from waypoint to waypoint by RRT
/// (rrt.h), smooths the resulting paths with regard to wind (smoothing.h), takes shortcuts that do
/// not worsen the score of a path, and rounds or rejects corners (corners.h). Among the paths that
/// the car can drive, the planner chooses the path with the best score (comparator.h). If no tree
/// reaches the goal and partial paths are allowed (Plan::partial), the result is the path that ends
/// nearest to the first unreached waypoint. A partial path ends at the tree's node that is nearest
/// to the unreached waypoint. If the car's front is too near to an obstacle at this node, the path
/// ends at the last earlier node at which the car is clear.
struct RrtPlannerOptions {
  Corners corners = Corners::kRound;
  /// Distance that the car's footprint keeps from obstacles [m], >= 0.
  double safe_distance = 0.3;
  /// Additional distance of the trees from obstacles, which leaves room for rounding the corners
  /// [m], >= 0.
  double corner_room = 1.0;
  double margin = 10.0;  ///< Margin of the sampled area around waypoints and obstacles [m].
  /// Maximum length of a straight stretch at the start of the path [m], >= 0; 0: no such stretch.
  double lead_in = 4.0;
  double min_speed = 0.5;  ///< Lowest speed of the car in a rounded corner [m/s].
  int trees = 10;          ///< Number of trees that the planner grows, > 0.
  int iterations = 10000;  ///< Maximum number of random samples for each leg of each tree, >= 0.
  double expand_distance = 2.0;  ///< Maximum length of a tree's edge [m], > 0.
  double goal_bias = 0.05;       ///< Fraction of the samples that are placed at the goal, 0 to 1.
  double data_weight = 0.1;      ///< Weight alpha of the original points in smoothing.
  /// Weight beta of smoothness in smoothing; 0 < alpha + 2 beta < 1.
  double smoothness_weight = 0.4;
  double corner_cost = 5.0;  ///< Cost of a corner, as an additional path length [m], >= 0.
  double wind_weight = 1.0;  ///< Weight k_w of the wind relative to the path length, >= 0.
  /// Time limit for growing trees, measured by PlanRequest::clock [s], > 0; nullopt: no limit.
  /// Smoothing and rounding take additional time.
  std::optional<double> time_limit{};
  /// Whether partial paths are allowed. If nullopt, partial paths are allowed only with a time
  /// limit.
  std::optional<bool> partial{};
};
void Visit(KeyVisitor& keys, RrtPlannerOptions& options);

/// Diagnostics of the tree that grows from one waypoint toward the next.
struct RrtLeg {
  RrtStatus status = RrtStatus::kReached;
  int iterations = 0;      ///< Number of random samples.
  std::size_t nodes = 0;   ///< Number of nodes of the tree.
  double length = 0.0;     ///< Length of the path in the tree [m].
  std::vector<Vec2> path;  ///< Points of the path in the tree [m].
  /// Number of sweeps of the smoothing; none if there was nothing to smooth.
  std::optional<int> sweeps;
  std::vector<Vec2> smooth;  ///< Points of the smoothed path [m].
};
void Visit(DiagnosticsVisitor& out, const RrtLeg& leg);

/// Status and score of one of the trees through all waypoints.
struct RrtTreeFindings {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;  ///< Reason why no path was found; empty if ok.
  PathScore score;     ///< Score of the tree's path.
  /// Distance from the end of a partial path to the unreached waypoint [m].
  std::optional<double> remaining;
};
void Visit(DiagnosticsVisitor& out, const RrtTreeFindings& own);

struct RrtDiagnostics {
  std::vector<RrtLeg> legs;            ///< Diagnostics of the chosen tree, for each leg.
  std::vector<RrtTreeFindings> trees;  ///< Status and score of each tree, in order of planning.
  int chosen = 0;                      ///< Index in `trees` of the tree that the planner chose.
  /// Diagnostics of a partial plan: the waypoint that was not reached, the distance from the end of
  /// the path to this waypoint [m], and the reason.
  struct Partial {
    std::size_t waypoint = 0;
    double remaining = 0.0;
    std::string reason;
  };
  std::optional<Partial> partial;
};
void Visit(DiagnosticsVisitor& out, const RrtDiagnostics& own);

PlannerEntry RrtPlanner();

}  // namespace trackbed
