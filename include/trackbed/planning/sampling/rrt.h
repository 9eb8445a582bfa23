#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "trackbed/geometry/box_index.h"
#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"

/// Plans paths of a point in the plane by RRT (LaValle 1998; listing "RRT Path Planner" of the
/// wind-aware RRT). A tree of straight edges grows toward random points until the tree reaches the
/// goal or the budget of samples is used up. If the budget is used up, the path ends at the tree's
/// node nearest to the goal.
namespace trackbed {

/// The problem of finding a path from a start to a goal around obstacles.
struct RrtProblem {
  Vec2 start{0.0, 0.0};  ///< Start of the path [m].
  Vec2 goal{0.0, 0.0};   ///< Goal of the path [m].
  Vec2 low{0.0, 0.0};    ///< Smallest x and y of the box from which samples are drawn [m].
  /// Largest x and y of the sampled box [m]; the box must contain start and goal.
  Vec2 high{0.0, 0.0};
  std::vector<OrientedBox> obstacles;
  Inflation inflation = 0.0;  ///< Smallest permitted distance of the path from the obstacles.
};

struct RrtOptions {
  int iterations = 5000;  ///< Maximum number of random samples, >= 0.
  /// Maximum length of an edge from the nearest node toward a sample [m], > 0. From a node closer
  /// to the goal than `expand_distance`, the search also tries to reach the goal directly.
  double expand_distance = 2.0;
  /// Fraction of the samples that are placed at the goal, 0 to 1; the original wind-aware RRT uses
  /// 0.
  double goal_bias = 0.05;
  /// Function that the search calls before every iteration; may be empty. If `stop` returns true,
  /// the search ends, for example because of a time limit. Planners read no clock themselves.
  std::function<bool()> stop;
};

enum class RrtStatus {
  kReached,  ///< The tree has reached the goal, and the path ends at the goal.
  /// The search has drawn all samples without reaching the goal. The path ends at the tree's node
  /// nearest to the goal.
  kIterations,
  /// The caller ended the search by `stop`. The path ends at the tree's node nearest to the goal.
  kStopped,
  /// The start is too near to an obstacle, so that there is no path.
  kStartBlocked,
  /// The goal is too near to an obstacle, so that there is no path.
  kGoalBlocked,
};

/// Returns the name of a status as written in plan.json: "reached", "iterations", ….
const char* ToString(RrtStatus status);

/// A node of the RRT tree. The first node of the tree is the start, which is its own parent.
struct RrtNode {
  Vec2 position{0.0, 0.0};
  std::size_t parent = 0;
};

struct RrtResult {
  RrtStatus status = RrtStatus::kIterations;
  /// Points of the path from the start on; empty if start or goal are too near to an obstacle [m].
  std::vector<Vec2> path;
  double length = 0.0;  ///< Length of the path [m].
  int iterations = 0;   ///< Number of iterations of the search.
  std::vector<RrtNode> nodes;

  [[nodiscard]] bool ok() const { return status == RrtStatus::kReached; }
};

/// Plans a path by RRT. Guarantees: every edge of the tree, including the last edge to the goal, is
/// over its whole length farther than `inflation` from every obstacle. No edge of the tree is
/// longer than `expand_distance`. The same problem, options and seed always yield the same tree.
/// With more iterations, the RRT search extends the tree of a search with fewer iterations. PlanRrt
/// returns the first path found, not the shortest path (see PlanRrtStar). The RRT path has corners,
/// and its direction at start and goal is arbitrary. Throws InternalError if start or goal are
/// outside the box, or if an option is out of range. Computing time per iteration: O(log n +
/// obstacles) for n nodes, about 1 us plus 20 ns per obstacle.
RrtResult PlanRrt(const RrtProblem& problem, const RrtOptions& options, std::uint64_t seed);

}  // namespace trackbed
