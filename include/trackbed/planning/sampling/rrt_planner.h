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

/// RRT from waypoint to waypoint (rrt.h), smoothed in the wind (smoothing.h), the points left out
/// that make it no better, its corners rounded or refused (corners.h). Of several trees the way
/// that the comparator prefers (comparator.h), of those that the car can drive. Where none reaches
/// the goal and a partial path is taken (Plan::partial), the one that gets nearest to the first
/// waypoint not reached: to its tree's node nearest to that, or, where the car cannot stand there
/// because its front reaches further than its rear axle, to the last node before at which it can.
struct RrtPlannerOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.3;      ///< of the footprint from obstacles [m], >= 0
  double corner_room = 1.0;        ///< that the trees keep besides, for rounded corners [m], >= 0
  double margin = 10.0;            ///< around waypoints and obstacles [m], within which to sample
  double lead_in = 4.0;            ///< straight on from the start, at most [m], >= 0; 0: none
  double min_speed = 0.5;          ///< no corner is taken more slowly [m/s]
  int trees = 10;                  ///< > 0
  int iterations = 10000;          ///< samples at most, for each leg of each tree, >= 0
  double expand_distance = 2.0;    ///< length of an edge at most [m], > 0
  double goal_bias = 0.05;         ///< share of samples at the goal, 0 to 1
  double data_weight = 0.1;        ///< alpha of the smoothing
  double smoothness_weight = 0.4;  ///< beta; 0 < alpha + 2 beta < 1
  double corner_cost = 5.0;        ///< of a corner, in meters of path [m], >= 0
  double wind_weight = 1.0;        ///< k_w: how much wind counts, in meters of path, >= 0
  /// After this time by PlanRequest::clock [s] no tree grows any more, > 0; none: no limit.
  /// Smoothing and rounding come on top of it.
  std::optional<double> time_limit{};
  /// Whether a partial path is taken; none: if there is a time limit.
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
  std::optional<int> sweeps;  ///< of the smoothing; none: there was nothing to smooth
  std::vector<Vec2> smooth;   ///< the smoothed path [m]
};
void Visit(DiagnosticsVisitor& out, const RrtLeg& leg);

/// One of the trees tried, through all waypoints, and what the comparator makes of it.
struct RrtTreeFindings {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;               ///< for people; empty when ok
  PathScore score;                  ///< of its path
  std::optional<double> remaining;  ///< of a partial path: to the waypoint not reached [m]
};
void Visit(DiagnosticsVisitor& out, const RrtTreeFindings& own);

struct RrtDiagnostics {
  std::vector<RrtLeg> legs;            ///< of the chosen tree
  std::vector<RrtTreeFindings> trees;  ///< in the order in which they were tried
  int chosen = 0;                      ///< index into `trees`
  /// Of a partial plan: the waypoint not reached, how far it is from the end [m], and why.
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
