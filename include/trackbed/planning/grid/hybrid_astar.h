#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path/path.h"
#include "trackbed/planning/common/plan_status.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/vehicle/params.h"

/// Hybrid A* (Dolgov et al. 2008): a search over the poses that a car can drive through, forwards
/// and backwards. The poses of the search are continuous. Only the cheapest pose is kept for each
/// cell of position and heading and each direction of travel.
///
/// Symbols: r radius of the sharpest arcs [m]; a step is an arc of curvature 0, +-1/(2r) or +-1/r.
/// The cost of a path is its length [m], with reverse stretches weighted by `reverse_cost`. Every
/// change of direction adds `switch_cost`. Every joint adds `steering_cost` times the change of
/// curvature relative to 1/r. The estimate of the cost-to-go is the larger of two lengths. The
/// first length is that of the shortest Reeds-Shepp curve. The second length is that of the
/// shortest grid path around the obstacles, divided by 1.0824, the largest ratio of a grid path's
/// length to that of a straight line.
namespace trackbed {

struct HybridAStarOptions {
  std::optional<double> radius;  ///< Radius r [m]; none: 1.1 times the car's smallest.
  double safe_distance = 0.3;    ///< Distance of the footprint from obstacles [m], >= 0.
  bool reverse = true;           ///< Whether reverse driving is allowed.
  double reverse_cost = 2.0;     ///< Cost of a meter backwards, >= 1.
  double switch_cost = 5.0;      ///< Cost of a change of direction [m], >= 0.
  double steering_cost = 2.0;    ///< Cost of a step of curvature of 1/r [m], >= 0.
  /// Weight of the cost-to-go, >= 1. Above 1, fewer poses are expanded, and the result costs at
  /// most `weight` times the optimum.
  double weight = 2.0;
  double cell = 0.5;       ///< Side of a cell [m], > 0.
  int headings = 72;       ///< Number of heading cells per full turn, >= 8.
  double margin = 10.0;    ///< Margin of the search area around start, goal and obstacles [m].
  double min_speed = 0.3;  ///< Lowest speed at a step of curvature [m/s].
  int budget = 200000;     ///< Maximum number of expanded poses, >= 0.
};
void Visit(KeyVisitor& keys, HybridAStarOptions& options);

struct HybridAStarProblem {
  Pose2 start;
  Pose2 goal;
  std::vector<OrientedBox> obstacles{};
  /// Whether the car rolls forwards at the start, so that it cannot begin backwards.
  bool rolls = false;
};

struct HybridAStarResult {
  PlanStatus status = PlanStatus::kNoPath;
  std::string reason;             ///< Reason of a failure; empty if ok.
  std::vector<Segment> segments;  ///< Segments from the start; empty unless ok.
  double cost = std::numeric_limits<double>::infinity();
  int expansions = 0;
  int cells = 0;  ///< Number of cells of the search area, without headings.

  [[nodiscard]] bool ok() const { return status == PlanStatus::kOk; }
};

/// Guarantees for the status kOk: the path ends at the goal pose within 1e-9 m and rad. The last
/// leg is a Reeds-Shepp curve, or a Dubins curve if reverse driving is not allowed. No curvature
/// exceeds 1/r. The car's footprint is clear of all obstacles (CollisionChecker). The same input
/// gives the same result. The path is not globally optimal: it is the cheapest path that the cells
/// distinguish and that ends with a Reeds-Shepp or Dubins curve. If the budget is used up, returns
/// the best path found so far. The status is kNoPath if all poses have been expanded. Throws
/// InternalError for options out of range. Cost: about 10 us per expansion.
HybridAStarResult SearchHybridAStar(const VehicleParams& vehicle, const HybridAStarProblem& problem,
                                    const HybridAStarOptions& options);

/// The search from one stop to the next.
struct HybridAStarLeg {
  double cost = 0.0;   ///< Cost of the path [m].
  int expansions = 0;  ///< Number of expanded poses.
  int cells = 0;       ///< Number of cells of the search area, without headings.
};
void Visit(DiagnosticsVisitor& out, const HybridAStarLeg& leg);

struct HybridAStarDiagnostics {
  std::vector<HybridAStarLeg> legs;
};
void Visit(DiagnosticsVisitor& out, const HybridAStarDiagnostics& own);

/// Returns the planner `hybrid_astar`.
PlannerEntry HybridAStarPlanner();

}  // namespace trackbed
