#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/planning/common/plan.h"

/// RRT* (Karaman and Frazzoli 2011) for a point in the plane: a tree of straight edges that grows
/// toward uniform samples. Each new node is connected to its cheapest neighbor. Neighbors are then
/// reconnected through the new node if that is cheaper.
namespace trackbed {

/// Start, goal and obstacles of a path.
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
  /// Maximum distance from the nearest node toward a sample [m]; 0: a fifth of the box's diagonal.
  double step = 0.0;
  double goal_bias = 0.05;  ///< Fraction of samples at the goal until the goal is reached, 0 to 1.
  /// Whether to skip nodes that cannot shorten the path once the goal is reached (Gammell et al.
  /// 2014). The distances of such a node from start and goal add up to at least the path's length.
  /// The search is then several times faster, with an equally short path; the tree no longer covers
  /// the box.
  bool informed = false;
  /// Called after every iteration; may be empty. The result true ends the search with the result so
  /// far.
  std::function<bool()> stop;
};

enum class RrtStarStatus {
  kFound,         ///< Path and cost of the best path found.
  kNotReached,    ///< The budget was used up before the goal was reached.
  kStartBlocked,  ///< The start lies within the inflation of an obstacle.
  kGoalBlocked,   ///< The goal lies within the inflation of an obstacle.
};

/// The spelling of a status in plan.json: "found", "not_reached", ….
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
/// obstacle, over its whole length. The cost of every node is the length of its path. A run with
/// more iterations starts like a run with fewer, so that its cost is never higher. The same
/// problem, options and seed give the same tree. The neighbors of a new node are its 1.1 x 12 e ln
/// n nearest nodes, more than the 2^(d+1) e (1 + 1/d) ln n with which the k-nearest form converges
/// to the optimum in d = 2 dimensions. The path is not smoothed; headings and curvature are
/// ignored. Errors: InternalError for a start or goal outside the box or options out of range.
/// Cost: O(neighbors), and O(neighbors x obstacles) for the edges, about 10 us per iteration.
RrtStarResult PlanRrtStar(const RrtStarProblem& problem, const RrtStarOptions& options,
                          std::uint64_t seed);

}  // namespace trackbed
