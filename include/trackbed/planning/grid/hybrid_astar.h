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

/// Hybrid A* (Dolgov et al. 2008): a search over poses that a car can drive through, forwards and
/// backwards. Poses are continuous; of those that fall into one cell of position and heading, come
/// to in one direction, only the cheapest is kept.
///
/// Symbols: r radius of the sharpest arcs [m]; a step is an arc of curvature 0, +-1/(2r) or +-1/r.
/// The cost of a path is its length [m], that of stretches backwards times `reverse_cost`, plus
/// `switch_cost` for every change of direction, plus `steering_cost` times the change of curvature
/// over 1/r at every joint. What is left to the goal is estimated by the greater of the shortest
/// Reeds-Shepp curve and the length of the path on a grid around the obstacles, over 1.0824, the
/// most by which steps between eight neighbors lengthen a straight.
namespace trackbed {

struct HybridAStarOptions {
  std::optional<double> radius;  ///< r [m]; none: a tenth more than the car's smallest
  double safe_distance = 0.3;    ///< of the footprint from obstacles [m], >= 0
  bool reverse = true;           ///< whether it may go backwards
  double reverse_cost = 2.0;     ///< of a meter backwards, >= 1
  double switch_cost = 5.0;      ///< of a change of direction [m], >= 0
  double steering_cost = 2.0;    ///< of a step of curvature of 1/r [m], >= 0
  double weight = 2.0;           ///< of what is left, >= 1: above 1 it looks at less, and what it
                                 ///< finds may cost so many times as much
  double cell = 0.5;             ///< side of a cell [m], > 0
  int headings = 72;             ///< cells of a full turn, >= 8
  double margin = 10.0;          ///< around start, goal and obstacles [m], within which to look
  double min_speed = 0.3;        ///< no step of curvature is taken more slowly [m/s]
  int budget = 200000;           ///< expansions, >= 0
};
void Visit(KeyVisitor& keys, HybridAStarOptions& options);

struct HybridAStarProblem {
  Pose2 start;
  Pose2 goal;
  std::vector<OrientedBox> obstacles{};
  bool rolls = false;  ///< forwards, at the start: it cannot begin backwards
};

struct HybridAStarResult {
  PlanStatus status = PlanStatus::kNoPath;
  std::string reason;             ///< for people; empty when ok
  std::vector<Segment> segments;  ///< from the start; empty unless ok
  double cost = std::numeric_limits<double>::infinity();
  int expansions = 0;
  int cells = 0;  ///< of the area, headings not counted

  [[nodiscard]] bool ok() const { return status == PlanStatus::kOk; }
};

/// Guarantees when ok: leads from the start to the goal pose within 1e-9 m and rad (the last leg is
/// a Reeds-Shepp curve, forwards alone a Dubins one); no curvature above 1/r; the footprint free
/// (CollisionChecker); the same for the same input. Not the cheapest path there is, but the
/// cheapest of those that the cells tell apart and a last curve ends. When the budget ends, the
/// best found by then. kNoPath when every pose has been looked at. InternalError for options out of
/// range. Cost: about 10 us an expansion.
HybridAStarResult SearchHybridAStar(const VehicleParams& vehicle, const HybridAStarProblem& problem,
                                    const HybridAStarOptions& options);

/// The search from one stop to the next.
struct HybridAStarLeg {
  double cost = 0.0;   ///< [m]
  int expansions = 0;  ///< poses that were looked at
  int cells = 0;       ///< of the area, headings not counted
};
void Visit(DiagnosticsVisitor& out, const HybridAStarLeg& leg);

struct HybridAStarDiagnostics {
  std::vector<HybridAStarLeg> legs;
};
void Visit(DiagnosticsVisitor& out, const HybridAStarDiagnostics& own);

/// The planner `hybrid_astar`.
PlannerEntry HybridAStarPlanner();

}  // namespace trackbed
