#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "trackbed/geometry/box_index.h"
#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/planning/common/plan.h"

/// Plans short paths of a point in the plane by RRT* (Karaman and Frazzoli 2011). A tree of
/// straight edges grows toward samples that are uniformly distributed. Each new node is connected
/// to the neighbor that yields the shortest path from the start to the new node. Each neighbor of
/// the new node is then reconnected through the new node if this shortens the path to the neighbor.
namespace trackbed {

/// The problem of finding a short path from a start to a goal around obstacles.
struct RrtStarProblem {
  Vec2 start{0.0, 0.0};  ///< Start of the path [m].
  Vec2 goal{0.0, 0.0};   ///< Goal of the path [m].
  Vec2 low{0.0, 0.0};    ///< Smallest x and y of the box from which samples are drawn [m].
  /// Largest x and y of the sampled box [m]; the box must contain start and goal.
  Vec2 high{0.0, 0.0};
  std::vector<OrientedBox> obstacles;
  Inflation inflation = 0.0;  ///< Smallest permitted distance of the path from the obstacles.
};

struct RrtStarOptions {
  int iterations = 2000;  ///< Number of random samples, >= 0.
  /// Maximum distance of a new node from the nearest node, toward a sample [m]; 0: a fifth of the
  /// sampled box's diagonal.
  double step = 0.0;
  /// Fraction of the samples that are placed at the goal until the goal is reached, 0 to 1.
  double goal_bias = 0.05;
  /// Whether the search, once the goal is reached, skips nodes that cannot shorten the path
  /// (Gammell et al. 2014). A node cannot shorten the path if its distances from start and goal add
  /// up to at least the length of the path. Skipping nodes that cannot shorten the path makes the
  /// search several times faster and the path equally short, but the tree no longer covers the
  /// sampled box.
  bool informed = false;
  /// Function that the search calls after every iteration; may be empty. If `stop` returns true,
  /// the search ends with the result so far.
  std::function<bool()> stop;
};

enum class RrtStarStatus {
  kFound,         ///< The search found a path; the result contains the shortest path found.
  kNotReached,    ///< The search used up its budget before it reached the goal.
  kStartBlocked,  ///< The start is too near to an obstacle.
  kGoalBlocked,   ///< The goal is too near to an obstacle.
};

/// Returns the name of a status as written in plan.json: "found", "not_reached", ….
const char* ToString(RrtStarStatus status);

struct RrtStarResult {
  RrtStarStatus status = RrtStarStatus::kNotReached;
  /// Points of the path from start to goal [m]; empty unless a path was found.
  std::vector<Vec2> path;
  double cost = 0.0;   ///< Length of the path [m]; infinite unless a path was found.
  int iterations = 0;  ///< Number of iterations of the search.
  std::vector<TreeNode> nodes;

  [[nodiscard]] bool ok() const { return status == RrtStarStatus::kFound; }
};

/// Plans a path by RRT*. Guarantees: every edge of the tree is over its whole length farther than
/// `inflation` from every obstacle. The cost of every node is the length of the tree's path from
/// the start to this node. A search with more iterations continues a search with fewer iterations,
/// so that more iterations never yield a longer path. The same problem, options and seed always
/// yield the same tree. The neighbors of a new node are the 1.1 x 12 e ln n nodes nearest to the
/// new node, where n is the number of the tree's nodes. To converge to the optimum, k-nearest RRT*
/// needs more than 2^(d+1) e (1 + 1/d) ln n neighbors, which is 12 e ln n in d = 2 dimensions. The
/// path is not smoothed, and ignores headings and curvature. Throws InternalError if start or goal
/// are outside the box, or if an option is out of range. Computing time per iteration:
/// O(neighbors), plus O(neighbors x obstacles) for testing edges, about 10 us in total.
RrtStarResult PlanRrtStar(const RrtStarProblem& problem, const RrtStarOptions& options,
                          std::uint64_t seed);

}  // namespace trackbed
