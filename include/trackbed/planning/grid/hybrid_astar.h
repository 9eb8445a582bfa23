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
/// and backwards. Poses are continuous; among poses in the same cell of position and heading,
/// reached in the same direction of travel, only the cheapest is kept.
///
/// Symbols: r radius of the sharpest arcs [m]; a step is an arc of curvature 0, +-1/(2r) or +-1/r.
/// The cost of a path is its length [m], with stretches backwards weighted by `reverse_cost`, plus
/// `switch_cost` for every change of direction, plus `steering_cost` times the change of curvature
/// relative to 1/r at every joint. The cost-to-go is estimated by the greater of the shortest
/// Reeds-Shepp curve and the length of the path on a grid around the obstacles, divided by 1.0824,
/// the largest factor by which steps between eight neighbors lengthen a straight line.
namespace trackbed {

struct HybridAStarOptions {
  std::optional<double> radius;  ///< r [m]; none: 1.1 times the car's smallest
  double safe_distance = 0.3;    ///< of the footprint from obstacles [m], >= 0
  bool reverse = true;           ///< allows reverse driving
  double reverse_cost = 2.0;     ///< of a meter backwards, >= 1
  double switch_cost = 5.0;      ///< of a change of direction [m], >= 0
  double steering_cost = 2.0;    ///< of a step of curvature of 1/r [m], >= 0
  double weight = 2.0;   ///< of the cost-to-go, >= 1: above 1 it expands less, and the result costs
                         ///< at most this many times the optimum
  double cell = 0.5;     ///< side of a cell [m], > 0
  int headings = 72;     ///< cells per full turn, >= 8
  double margin = 10.0;  ///< of the search area around start, goal and obstacles [m]
  double min_speed = 0.3;  ///< lowest speed at a step of curvature [m/s]
  int budget = 200000;     ///< expansions, >= 0
};
void Visit(KeyVisitor& keys, HybridAStarOptions& options);

struct HybridAStarProblem {
  Pose2 start;
  Pose2 goal;
  std::vector<OrientedBox> obstacles{};
  bool rolls = false;  ///< the car rolls forwards at the start, so that it cannot begin backwards
};

struct HybridAStarResult {
  PlanStatus status = PlanStatus::kNoPath;
  std::string reason;             ///< empty when ok
  std::vector<Segment> segments;  ///< from the start; empty unless ok
  double cost = std::numeric_limits<double>::infinity();
  int expansions = 0;
  int cells = 0;  ///< of the search area, without headings

  [[nodiscard]] bool ok() const { return status == PlanStatus::kOk; }
};

/// Guarantees when ok: the path ends at the goal pose within 1e-9 m and rad (the last leg is a
/// Reeds-Shepp curve, or a Dubins curve without reverse driving); no curvature above 1/r; the
/// footprint is free (CollisionChecker); the same input gives the same result. The path is not
/// globally optimal: it is the cheapest that the cells distinguish and that ends with a last curve.
/// If the budget is used up, returns the best path found so far. kNoPath if all poses have been
/// expanded. InternalError for options out of range. Cost: about 10 us per expansion.
HybridAStarResult SearchHybridAStar(const VehicleParams& vehicle, const HybridAStarProblem& problem,
                                    const HybridAStarOptions& options);

/// The search from one stop to the next.
struct HybridAStarLeg {
  double cost = 0.0;   ///< [m]
  int expansions = 0;  ///< expanded poses
  int cells = 0;       ///< of the search area, without headings
};
void Visit(DiagnosticsVisitor& out, const HybridAStarLeg& leg);

struct HybridAStarDiagnostics {
  std::vector<HybridAStarLeg> legs;
};
void Visit(DiagnosticsVisitor& out, const HybridAStarDiagnostics& own);

/// The planner `hybrid_astar`.
PlannerEntry HybridAStarPlanner();

}  // namespace trackbed
