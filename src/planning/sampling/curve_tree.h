#pragma once

#include <cstdint>
#include <vector>

#include "src/planning/curves/continuous_legs.h"
#include "trackbed/planning/common/plan.h"

/// Grows a tree of curves of continuous curvature by RRT* (Karaman and Frazzoli 2011).
namespace trackbed {

/// The problem of joining two stops by legs of continuous curvature around obstacles.
struct CurveTreeProblem {
  LegEnds ends;                ///< Both stops, and the place of the path between them in the route.
  Pose2 frame;                 ///< Frame in which the samples are drawn.
  Vec2 low{0.0, 0.0};          ///< Smallest x and y of the sampled box in the frame [m].
  Vec2 high{0.0, 0.0};         ///< Largest x and y of the sampled box in the frame [m].
  std::vector<double> speeds;  ///< Choices of speeds on the turns of an edge [m/s].
  double fastest = 1.0;        ///< Largest speed on any edge [m/s].
  int iterations = 0;          ///< Number of random samples, >= 0.
  /// Maximum distance of a new node from the nearest node, toward a sample [m], > 0.
  double step = 1.0;
};

struct CurveTreeResult {
  /// Poses from the start to the goal; empty unless a path was found.
  std::vector<Pose2> path;
  double cost = kNoCurve;  ///< Estimated driving time of the path [s].
  double length = 0.0;     ///< Length of the path [m]; 0 unless a path was found.
  int iterations = 0;      ///< Number of iterations of the search.
  /// Nodes in the world frame, the start first. The cost of a node is the length of its path.
  std::vector<TreeNode> nodes;

  [[nodiscard]] bool ok() const { return cost < kNoCurve; }
};

/// Grows a tree from the stop `ends.from` to the stop `ends.to`. The nodes of the tree are poses
/// with straight wheels. Each edge is the cheapest leg of `finder` that is free of obstacles, for
/// one of the speeds. Guarantees: a search with more iterations continues a search with fewer
/// iterations, so that more iterations never increase the cost of the path. The same problem and
/// seed always yield the same tree. Computing time
/// per iteration: up to about 10 ms while the goal is not reached, then about 1 ms.
CurveTreeResult GrowCurveTree(LegFinder& finder, const CurveTreeProblem& problem,
                              std::uint64_t seed);

}  // namespace trackbed
