#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/planning/common/plan_diagnostics.h"
#include "trackbed/planning/sampling/comparator.h"
#include "trackbed/planning/sampling/rrt.h"

namespace trackbed {

/// Diagnostics of the tree that grows from one waypoint toward the next.
struct RrtLeg {
  RrtStatus status = RrtStatus::kReached;
  int iterations = 0;      ///< Number of random samples that the search drew.
  std::size_t nodes = 0;   ///< Number of nodes of the tree.
  double length = 0.0;     ///< Length of the path in the tree [m].
  std::vector<Vec2> path;  ///< Points of the path in the tree [m].
  /// Number of smoothing sweeps over the path; none if there was nothing to smooth.
  std::optional<int> sweeps;
  std::vector<Vec2> smooth;  ///< Points of the smoothed path [m].
};
void Visit(DiagnosticsVisitor& out, const RrtLeg& leg);

/// Status and score of one search tree that leads through all waypoints.
struct RrtTreeFindings {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;  ///< Reason why no path was found; empty if ok.
  PathScore score;     ///< Score of the tree's path.
  /// Distance from the end of a partial path to the unreached waypoint [m].
  std::optional<double> remaining;
};
void Visit(DiagnosticsVisitor& out, const RrtTreeFindings& own);

struct RrtDiagnostics {
  std::vector<RrtLeg> legs;  ///< Diagnostics of the chosen search tree, for each leg of the route.
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

}  // namespace trackbed
