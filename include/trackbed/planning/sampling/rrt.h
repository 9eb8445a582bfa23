#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"

/// RRT for a point in the plane (LaValle 1998; listing "RRT Path Planner" of the wind-aware RRT): a
/// tree of straight edges that grows toward random points until it reaches the goal or uses up its
/// budget. In the latter case the path ends at the node nearest to the goal.
namespace trackbed {

/// Start, goal and obstacles of a path.
struct RrtProblem {
  Vec2 start{0.0, 0.0};  ///< [m]
  Vec2 goal{0.0, 0.0};   ///< [m]
  Vec2 low{0.0, 0.0};    ///< corner of the box that is sampled, smallest x and y [m]
  Vec2 high{0.0, 0.0};   ///< the opposite corner; start and goal lie within the box
  std::vector<OrientedBox> obstacles;
  double inflation = 0.0;  ///< the path keeps further than this from every obstacle [m], >= 0
};

struct RrtOptions {
  int iterations = 5000;  ///< maximum number of samples, >= 0
  /// Maximum distance from the nearest node toward a sample; also the distance from which the goal
  /// is tried [m], > 0.
  double expand_distance = 2.0;
  double goal_bias = 0.05;  ///< fraction of samples at the goal, 0 to 1; wind-aware RRT: 0
  /// Called before every iteration (may be empty): true ends the search, for example at a time
  /// limit. Planners read no clock themselves.
  std::function<bool()> stop;
};

enum class RrtStatus {
  kReached,       ///< the path ends at the goal
  kIterations,    ///< all samples are drawn; the path ends at the node nearest to the goal
  kStopped,       ///< the caller ended the search; the path ends at the node nearest to the goal
  kStartBlocked,  ///< the start lies within the inflation of an obstacle; no path
  kGoalBlocked,   ///< the goal lies within the inflation of an obstacle; no path
};

/// "reached", "iterations", …: the spelling of plan.json.
const char* ToString(RrtStatus status);

/// A node of the tree; the first one is the start, which is its own parent.
struct RrtNode {
  Vec2 position{0.0, 0.0};
  std::size_t parent = 0;
};

struct RrtResult {
  RrtStatus status = RrtStatus::kIterations;
  std::vector<Vec2> path;  ///< from the start; empty if start or goal are blocked
  double length = 0.0;     ///< of the path [m]
  int iterations = 0;      ///< used
  std::vector<RrtNode> nodes;

  [[nodiscard]] bool ok() const { return status == RrtStatus::kReached; }
};

/// Guarantees: every edge, including the last one to the goal, keeps further than the inflation
/// from every obstacle over its whole length; edges are no longer than the expand distance; the
/// same problem, options and seed give the same tree; a run with more iterations starts like one
/// with fewer. Returns the first path found: it is not the shortest (RrtStar), has corners, and
/// ignores headings. Errors: InternalError for a start or goal outside the box or options out of
/// range. Cost: O(log n + obstacles) per iteration, about 1 us and 20 ns per obstacle.
RrtResult PlanRrt(const RrtProblem& problem, const RrtOptions& options, std::uint64_t seed);

}  // namespace trackbed
