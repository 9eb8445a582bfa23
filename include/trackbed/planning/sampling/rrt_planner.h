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

/// Options of the planner `rrt`. The planner grows trees from waypoint to waypoint by RRT (rrt.h),
/// smooths their paths with regard to wind (smoothing.h), takes shortcuts that do not worsen the
/// score of a path, and rounds or rejects corners (corners.h). The comparator (comparator.h)
/// chooses the best of the paths that the car can drive. If no tree reaches the goal and partial
/// paths are allowed (Plan::partial), the result is the path that ends nearest to the first
/// unreached waypoint. A partial path ends at the node of the tree that is nearest to this
/// waypoint. If the car's front does not fit at the nearest node, the path ends at the last earlier
/// node at which the car fits.
struct RrtPlannerOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.3;  ///< Distance of the footprint from obstacles [m], >= 0.
  /// Additional distance of the trees from obstacles, which leaves room for rounded corners [m], >=
  /// 0.
  double corner_room = 1.0;
  double margin = 10.0;  ///< Margin of the sampled area around waypoints and obstacles [m].
  double lead_in = 4.0;  ///< Maximum length of a straight stretch at the start [m], >= 0; 0: none.
  double min_speed = 0.5;          ///< Lowest speed in a corner [m/s].
  int trees = 10;                  ///< Number of trees, > 0.
  int iterations = 10000;          ///< Maximum number of samples, for each leg of each tree, >= 0.
  double expand_distance = 2.0;    ///< Maximum length of an edge [m], > 0.
  double goal_bias = 0.05;         ///< Fraction of samples at the goal, 0 to 1.
  double data_weight = 0.1;        ///< Weight alpha of the smoothing.
  double smoothness_weight = 0.4;  ///< Weight beta of the smoothing; 0 < alpha + 2 beta < 1.
  double corner_cost = 5.0;        ///< Cost of a corner, as path length [m], >= 0.
  double wind_weight = 1.0;        ///< Weight k_w of wind, relative to path length, >= 0.
  /// Time [s] after which trees stop growing, measured by PlanRequest::clock, > 0; nullopt: no
  /// limit. Smoothing and rounding take additional time.
  std::optional<double> time_limit{};
  /// Whether partial paths are allowed. Nullopt: partial paths are allowed only with a time limit.
  std::optional<bool> partial{};
};
void Visit(KeyVisitor& keys, RrtPlannerOptions& options);

/// The tree from one waypoint toward the next.
struct RrtLeg {
  RrtStatus status = RrtStatus::kReached;
  int iterations = 0;         ///< Number of samples.
  std::size_t nodes = 0;      ///< Number of nodes of the tree.
  double length = 0.0;        ///< Length of the tree's path [m].
  std::vector<Vec2> path;     ///< Path of the tree [m].
  std::optional<int> sweeps;  ///< Number of smoothing sweeps; none if there was nothing to smooth.
  std::vector<Vec2> smooth;   ///< The smoothed path [m].
};
void Visit(DiagnosticsVisitor& out, const RrtLeg& leg);

/// Findings on one of the trees through all waypoints, with its score.
struct RrtTreeFindings {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;  ///< Reason of a failure; empty if ok.
  PathScore score;     ///< Score of the path.
  /// Distance of a partial path from the unreached waypoint [m].
  std::optional<double> remaining;
};
void Visit(DiagnosticsVisitor& out, const RrtTreeFindings& own);

struct RrtDiagnostics {
  std::vector<RrtLeg> legs;            ///< Legs of the chosen tree.
  std::vector<RrtTreeFindings> trees;  ///< Findings on the trees, in order of planning.
  int chosen = 0;                      ///< Index of the chosen tree in `trees`.
  /// Findings on a partial plan: the waypoint that was not reached, its distance from the end of
  /// the path [m], and the reason.
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
