#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/planning/common/plan.h"

/// RRT* (Karaman and Frazzoli 2011) for a point in the plane: a tree of straight edges that grows
/// toward uniform samples. Each new node is connected to its cheapest neighbor, and neighbors are
/// reconnected through it if that is cheaper.
namespace trackbed {

/// Start, goal and obstacles of a path.
struct RrtStarProblem {
  Vec2 start{0.0, 0.0};  ///< [m]
  Vec2 goal{0.0, 0.0};   ///< [m]
  Vec2 low{0.0, 0.0};    ///< corner of the box that is sampled, smallest x and y [m]
  Vec2 high{0.0, 0.0};   ///< the opposite corner; start and goal lie within the box
  std::vector<OrientedBox> obstacles;
  double inflation = 0.0;  ///< the path keeps further than this from every obstacle [m], >= 0
};

struct RrtStarOptions {
  int iterations = 2000;  ///< samples drawn, >= 0
  /// Maximum distance from the nearest node toward a sample [m]; 0: a fifth of the box's diagonal.
  double step = 0.0;
  double goal_bias = 0.05;  ///< fraction of samples at the goal until it is reached, 0 to 1
  /// Once the goal is reached, skips nodes that cannot shorten the path (Gammell et al. 2014):
  /// those whose distances from start and goal add up to at least the path's length. Several times
  /// faster, with an equally short path; the tree then no longer covers the box.
  bool informed = false;
  /// Called after every iteration (may be empty): true ends the search with the result so far.
  std::function<bool()> stop;
};

enum class RrtStarStatus {
  kFound,         ///< path and cost are those of the best path found
  kNotReached,    ///< the budget was used up before the goal was reached
  kStartBlocked,  ///< the start lies within the inflation of an obstacle
  kGoalBlocked,   ///< the goal lies within the inflation of an obstacle
};

/// "found", "not_reached", …: the spelling of plan.json.
const char* ToString(RrtStarStatus status);

struct RrtStarResult {
  RrtStarStatus status = RrtStarStatus::kNotReached;
  std::vector<Vec2> path;  ///< start to goal; empty unless found
  double cost = 0.0;       ///< its length [m]; infinite unless found
  int iterations = 0;      ///< used
  std::vector<TreeNode> nodes;

  [[nodiscard]] bool ok() const { return status == RrtStarStatus::kFound; }
};

/// Guarantees: every edge of the tree stays further than the inflation from every obstacle, over
/// its whole length; the cost of every node is the length of its path; a run with more iterations
/// starts like one with fewer, so that its cost is never higher; the same problem, options and seed
/// give the same tree. The neighbors of a new node are its 1.1 x 12 e ln n nearest nodes, more than
/// the 2^(d+1) e (1 + 1/d) ln n with which the k-nearest form converges to the optimum in d = 2
/// dimensions. Does not smooth, and ignores headings and curvature. Errors: InternalError for a
/// start or goal outside the box or options out of range. Cost: O(neighbors), and O(neighbors x
/// obstacles) for the edges, about 10 us per iteration.
RrtStarResult PlanRrtStar(const RrtStarProblem& problem, const RrtStarOptions& options,
                          std::uint64_t seed);

}  // namespace trackbed
