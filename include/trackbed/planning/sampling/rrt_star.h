#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/planning/common/plan.h"

/// RRT* (Karaman and Frazzoli 2011) for a point in the plane: a tree of straight edges that grows
/// toward uniform samples. Each new node is connected to the neighbor through which its cost is
/// lowest. Neighbors are then reconnected through the new node if that lowers their cost.
namespace trackbed {

/// The problem of finding a path: start, goal and obstacles.
struct RrtStarProblem {
  Vec2 start{0.0, 0.0};  ///< Start of the path [m].
  Vec2 goal{0.0, 0.0};   ///< Goal of the path [m].
  Vec2 low{0.0, 0.0};    ///< Smallest x and y of the sampled box [m].
  Vec2 high{0.0, 0.0};   ///< Largest x and y of the box, which contains start and goal.
  std::vector<OrientedBox> obstacles;
  double inflation = 0.0;  ///< Smallest distance of the path from every obstacle [m], >= 0.
};

struct RrtStarOptions {
  int iterations = 2000;  ///< Number of samples, >= 0.
  /// Maximum distance of a new node from the nearest node, toward a sample [m]; 0: a fifth of the
  /// box's diagonal.
  double step = 0.0;
  double goal_bias = 0.05;  ///< Fraction of samples at the goal until the goal is reached, 0 to 1.
  /// Whether to skip nodes that cannot shorten the path, once the goal is reached (Gammell et al.
  /// 2014). A node cannot shorten the path if its distances from start and goal add up to at least
  /// the length of the path. With this option, the search is several times faster and the path is
  /// equally short, but the tree no longer covers the box.
  bool informed = false;
  /// Function that the search calls after every iteration; may be empty. If the function returns
  /// true, the search ends with the result so far.
  std::function<bool()> stop;
};

enum class RrtStarStatus {
  kFound,         ///< A path was found. The result contains the best path and its cost.
  kNotReached,    ///< The search used up its budget before it reached the goal.
  kStartBlocked,  ///< The start lies within the inflation of an obstacle.
  kGoalBlocked,   ///< The goal lies within the inflation of an obstacle.
};

/// Returns the spelling of a status in plan.json: "found", "not_reached", ….
const char* ToString(RrtStarStatus status);

struct RrtStarResult {
  RrtStarStatus status = RrtStarStatus::kNotReached;
  std::vector<Vec2> path;  ///< Path from start to goal; empty unless found.
  double cost = 0.0;       ///< Length of the path [m]; infinite unless found.
  int iterations = 0;      ///< Number of iterations used.
  std::vector<TreeNode> nodes;

  [[nodiscard]] bool ok() const { return status == RrtStarStatus::kFound; }
};

/// Plans a path. Guarantees: every edge of the tree is farther than the inflation from every
/// obstacle, over its whole length. The cost of every node is the length of the path from the start
/// to the node. A run with more iterations starts like a run with fewer iterations, so that its
/// cost is never higher. The same problem, options and seed give the same tree. The neighbors of a
/// new node are its 1.1 x 12 e ln n nearest nodes, where n is the number of nodes. To converge to
/// the optimum, k-nearest RRT* needs more than 2^(d+1) e (1 + 1/d) ln n neighbors, which is 12 e ln
/// n in d = 2 dimensions. The path is not smoothed; headings and curvature are ignored. Errors:
/// InternalError for a start or goal outside the box or options out of range. Cost: O(neighbors),
/// and O(neighbors x obstacles) for the edges, about 10 us per iteration.
RrtStarResult PlanRrtStar(const RrtStarProblem& problem, const RrtStarOptions& options,
                          std::uint64_t seed);

}  // namespace trackbed
