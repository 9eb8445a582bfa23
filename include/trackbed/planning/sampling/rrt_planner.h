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

/// Options of the planner `rrt`: RRT from waypoint to waypoint (rrt.h), smoothed with regard to
/// wind (smoothing.h), shortcut where that is not worse, with corners rounded or rejected
/// (corners.h). Plans several trees and takes the path that the comparator prefers (comparator.h)
/// among those that the car can drive. If no tree reaches the goal and partial paths are allowed
/// (Plan::partial), takes the path that gets nearest to the first waypoint not reached. Such a path
/// ends at the tree's nearest node, or, where the car's front does not fit there, at the last node
/// before it at which the car fits.
struct RrtPlannerOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.3;  ///< of the footprint from obstacles [m], >= 0
  double corner_room = 1.0;    ///< additional distance of the trees, for rounded corners [m], >= 0
  double margin = 10.0;        ///< of the sampled area around waypoints and obstacles [m]
  double lead_in = 4.0;        ///< maximum straight stretch at the start [m], >= 0; 0: none
  double min_speed = 0.5;      ///< lowest speed in a corner [m/s]
  int trees = 10;              ///< > 0
  int iterations = 10000;      ///< maximum number of samples, for each leg of each tree, >= 0
  double expand_distance = 2.0;    ///< maximum length of an edge [m], > 0
  double goal_bias = 0.05;         ///< fraction of samples at the goal, 0 to 1
  double data_weight = 0.1;        ///< alpha of the smoothing
  double smoothness_weight = 0.4;  ///< beta; 0 < alpha + 2 beta < 1
  double corner_cost = 5.0;        ///< of a corner, as path length [m], >= 0
  double wind_weight = 1.0;        ///< k_w: weight of wind, relative to path length, >= 0
  /// Time by PlanRequest::clock [s] after which trees stop growing, > 0; none: no limit. Smoothing
  /// and rounding take additional time.
  std::optional<double> time_limit{};
  /// Whether partial paths are allowed; none: only with a time limit.
  std::optional<bool> partial{};
};
void Visit(KeyVisitor& keys, RrtPlannerOptions& options);

/// The tree from one waypoint toward the next.
struct RrtLeg {
  RrtStatus status = RrtStatus::kReached;
  int iterations = 0;         ///< samples
  std::size_t nodes = 0;      ///< of the tree
  double length = 0.0;        ///< of its path [m]
  std::vector<Vec2> path;     ///< of the tree [m]
  std::optional<int> sweeps;  ///< of the smoothing; none: nothing to smooth
  std::vector<Vec2> smooth;   ///< the smoothed path [m]
};
void Visit(DiagnosticsVisitor& out, const RrtLeg& leg);

/// One of the trees, through all waypoints, with its score.
struct RrtTreeFindings {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;               ///< empty when ok
  PathScore score;                  ///< of its path
  std::optional<double> remaining;  ///< of a partial path: distance to the waypoint not reached [m]
};
void Visit(DiagnosticsVisitor& out, const RrtTreeFindings& own);

struct RrtDiagnostics {
  std::vector<RrtLeg> legs;            ///< of the chosen tree
  std::vector<RrtTreeFindings> trees;  ///< in order of planning
  int chosen = 0;                      ///< index into `trees`
  /// Of a partial plan: the waypoint not reached, its distance from the end [m], and the reason.
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
