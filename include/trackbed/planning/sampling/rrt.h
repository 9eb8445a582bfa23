#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"

/// RRT for a point in the plane (LaValle 1998; listing "RRT Path Planner" of the wind-aware RRT): a
/// tree of straight edges that grows toward random points until it reaches the goal or uses up its
/// budget. If the budget is used up, the path ends at the node nearest to the goal.
namespace trackbed {

/// The problem of finding a path: start, goal and obstacles.
struct RrtProblem {
  Vec2 start{0.0, 0.0};  ///< Start of the path [m].
  Vec2 goal{0.0, 0.0};   ///< Goal of the path [m].
  Vec2 low{0.0, 0.0};    ///< Smallest x and y of the sampled box [m].
  Vec2 high{0.0, 0.0};   ///< Largest x and y of the box, which contains start and goal.
  std::vector<OrientedBox> obstacles;
  double inflation = 0.0;  ///< Smallest distance of the path from every obstacle [m], >= 0.
};

struct RrtOptions {
  int iterations = 5000;  ///< Maximum number of samples, >= 0.
  /// Maximum distance of a new node from the nearest node, toward a sample [m], > 0. From a node
  /// within this distance of the goal, the search also tries to reach the goal.
  double expand_distance = 2.0;
  /// Fraction of samples at the goal, 0 to 1; the original wind-aware RRT uses 0.
  double goal_bias = 0.05;
  /// Function that the search calls before every iteration; may be empty. If the function returns
  /// true, the search ends, for example at a time limit. Planners read no clock themselves.
  std::function<bool()> stop;
};

enum class RrtStatus {
  kReached,  ///< The path ends at the goal.
  /// All samples were drawn. The path ends at the node nearest to the goal.
  kIterations,
  /// The caller ended the search. The path ends at the node nearest to the goal.
  kStopped,
  /// The start lies within the inflation of an obstacle, so that there is no path.
  kStartBlocked,
  /// The goal lies within the inflation of an obstacle, so that there is no path.
  kGoalBlocked,
};

/// Returns the spelling of a status in plan.json: "reached", "iterations", ….
const char* ToString(RrtStatus status);

/// A node of the tree. The first node is the start, which is its own parent.
struct RrtNode {
  Vec2 position{0.0, 0.0};
  std::size_t parent = 0;
};

struct RrtResult {
  RrtStatus status = RrtStatus::kIterations;
  std::vector<Vec2> path;  ///< Path from the start; empty if start or goal are blocked.
  double length = 0.0;     ///< Length of the path [m].
  int iterations = 0;      ///< Number of iterations used.
  std::vector<RrtNode> nodes;

  [[nodiscard]] bool ok() const { return status == RrtStatus::kReached; }
};

/// Plans a path. Guarantees: every edge, including the last one to the goal, is farther than the
/// inflation from every obstacle over its whole length. Edges are no longer than the expand
/// distance. The same problem, options and seed give the same tree. A run with more iterations
/// starts like a run with fewer iterations. The result is the first path found, not the shortest
/// path (see PlanRrtStar). The path has corners and ignores headings. Errors: InternalError for a
/// start or goal outside the box, or for options out of range. Cost: O(log n + obstacles) per
/// iteration, about 1 us plus 20 ns per obstacle.
RrtResult PlanRrt(const RrtProblem& problem, const RrtOptions& options, std::uint64_t seed);

}  // namespace trackbed
