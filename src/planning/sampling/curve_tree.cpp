#include "src/planning/sampling/curve_tree.h"

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>

#include "src/planning/sampling/node_grid.h"
#include "trackbed/core/angle.h"

// RRT* (Karaman and Frazzoli 2011) among poses with straight wheels.
// 1. A sample is a position and a heading. The position is moved toward the nearest node until it
//    is within one step. Half of the samples head away from the nearest node.
// 2. The parent of a new node is the neighbor with the cheapest path. An edge is the cheapest free
//    leg of continuous curvature, which LegFinder finds. A sample at which the car does not fit, or
//    to which several neighbors have no free leg, is dropped.
// 3. Neighbors and the goal are rewired through the new node where this makes their paths cheaper.
// 4. Before each search for a leg, a straight line at the largest speed bounds the cost of the leg.
//    Most pairs of nodes need no search, because this bound exceeds the best cost so far.

namespace trackbed {
namespace {

/// Factor in the number of neighbors, a tenth above the bound 2^(d+1) e (1 + 1/d) of k-nearest RRT*
/// for d = 3 dimensions: two of the position, one of the heading.
constexpr double kNeighborPoses = 1.1 * 64.0 / 3.0 * 2.718281828459045;

/// Number of neighbors without a free leg to a sample after which the sample is dropped. Behind a
/// wall, no neighbor has such a leg, and each search for one takes about a millisecond.
constexpr int kMostFailed = 8;

constexpr std::size_t kStart = 0;
constexpr std::size_t kGoal = 1;

class CurveTree {
 public:
  CurveTree(LegFinder& finder, const CurveTreeProblem& problem, std::uint64_t seed)
      : finder_(finder), problem_(problem), random_(seed), index_(problem.low, problem.high) {
    Add(problem.ends.from.pose, kStart);
    nodes_[kStart].cost = 0.0;
    Add(problem.ends.to.pose, kStart);
    index_.Add(ToLocal(problem.frame, problem.ends.from.pose.position()), kStart);
    Rewire(kGoal, kStart);
  }

  CurveTreeResult Grow() {
    CurveTreeResult result;
    for (; result.iterations < problem_.iterations; ++result.iterations) {
      Iterate();
    }
    result.cost = nodes_[kGoal].cost;
    if (result.ok()) {
      for (std::size_t node = kGoal; node != kStart; node = nodes_[node].parent) {
        result.path.push_back(nodes_[node].pose);
        result.length += nodes_[node].length;
      }
      result.path.push_back(nodes_[kStart].pose);
      std::reverse(result.path.begin(), result.path.end());
    }
    AddNodes(result.nodes);
    return result;
  }

 private:
  struct Node {
    Pose2 pose;
    std::size_t parent = 0;
    double cost = kNoCurve;  // driving time from the start [s]
    double edge = 0.0;       // driving time from the parent [s]
    double length = 0.0;     // length of the edge from the parent [m]
    std::vector<std::size_t> children;
  };
  struct Neighbor {
    std::size_t node;
    double least;  // lower bound of the cost of the new node through this neighbor
  };

  double Uniform() { return boost::random::uniform_01<double>()(random_); }

  std::size_t Add(const Pose2& pose, std::size_t parent) {
    nodes_.push_back({.pose = pose, .parent = parent, .children = {}});
    return nodes_.size() - 1;
  }

  /// Returns a lower bound of the driving time between two positions [s].
  [[nodiscard]] double LeastTime(const Pose2& a, const Pose2& b) const {
    return (a.position() - b.position()).norm() / problem_.fastest;
  }

  [[nodiscard]] CurveState StateAt(std::size_t node) const {
    return node == kStart ? problem_.ends.from : CurveState{nodes_[node].pose};
  }

  /// Returns the cheapest free leg between two nodes that costs at most `bound`.
  [[nodiscard]] ContinuousLeg Leg(std::size_t from, std::size_t to, double bound) {
    return finder_.Cheapest({.from = StateAt(from),
                             .to = to == kGoal ? problem_.ends.to : StateAt(to),
                             .is_first = from == kStart && problem_.ends.is_first,
                             .is_last = to == kGoal && problem_.ends.is_last},
                            problem_.speeds, bound);
  }

  void Iterate() {
    // Always draw four random numbers, so that each sample is independent of the tree.
    const double x = Uniform();
    const double y = Uniform();
    const double heading = Uniform();
    const bool goes_away = Uniform() < 0.5;
    const Vec2 sample(std::lerp(problem_.low.x(), problem_.high.x(), x),
                      std::lerp(problem_.low.y(), problem_.high.y(), y));
    const Vec2 nearest = ToLocal(problem_.frame, nodes_[index_.Nearest(sample)].pose.position());
    const Vec2 offset = sample - nearest;
    const double distance = offset.norm();
    if (distance == 0.0) {
      return;
    }
    const Vec2 position = nearest + offset * std::min(1.0, problem_.step / distance);
    const double yaw = goes_away ? std::atan2(offset.y(), offset.x()) : kPi * (2.0 * heading - 1.0);
    Join(Compose(problem_.frame, {position.x(), position.y(), yaw}), position);
  }

  /// Adds a node with its cheapest parent, and rewires its neighbors.
  void Join(const Pose2& pose, const Vec2& position) {
    if (!finder_.IsFree(pose)) {
      return;
    }
    // A path through the node must be cheaper than the best path so far.
    const double most = nodes_[kGoal].cost - LeastTime(pose, nodes_[kGoal].pose);
    const double count = std::ceil(kNeighborPoses * std::log(static_cast<double>(nodes_.size())));
    index_.FindNearest(position, static_cast<std::size_t>(count), near_);
    neighbors_.clear();
    for (const auto& [square, node] : near_) {
      const double least = nodes_[node].cost + LeastTime(nodes_[node].pose, pose);
      if (least < most) {
        neighbors_.push_back({node, least});
      }
    }
    std::sort(neighbors_.begin(), neighbors_.end(), [](const Neighbor& a, const Neighbor& b) {
      return a.least < b.least || (a.least == b.least && a.node < b.node);
    });
    const std::size_t node = Add(pose, kStart);
    int failed = 0;
    for (const Neighbor& neighbor : neighbors_) {
      Rewire(node, neighbor.node, most);
      failed += nodes_[node].cost == kNoCurve ? 1 : 0;
      if (failed == kMostFailed) {
        break;
      }
    }
    if (nodes_[node].cost == kNoCurve) {
      nodes_.pop_back();
      return;
    }
    index_.Add(position, node);
    Rewire(kGoal, node);
    // The start has the cost 0, so it is never rewired.
    for (const auto& [square, other] : near_) {
      if (other != nodes_[node].parent) {
        Rewire(other, node);
      }
    }
  }

  /// Makes `parent` the parent of a node if this makes the path to the node cheaper than the
  /// present path, and cheaper than `most`.
  void Rewire(std::size_t node, std::size_t parent, double most = kNoCurve) {
    const double before = nodes_[parent].cost;
    const double bound = std::min(nodes_[node].cost, most) - before;
    if (LeastTime(nodes_[parent].pose, nodes_[node].pose) >= bound) {
      return;
    }
    const ContinuousLeg leg = Leg(parent, node, bound);
    if (leg.cost >= bound) {
      return;
    }
    if (nodes_[node].cost < kNoCurve) {
      std::erase(nodes_[nodes_[node].parent].children, node);
    }
    nodes_[parent].children.push_back(node);
    nodes_[node].parent = parent;
    nodes_[node].edge = leg.cost;
    nodes_[node].length = leg.findings.length;
    // Update the costs of the node and all its descendants.
    std::vector<std::size_t> open{node};
    while (!open.empty()) {
      Node& at = nodes_[open.back()];
      open.pop_back();
      at.cost = nodes_[at.parent].cost + at.edge;
      open.insert(open.end(), at.children.begin(), at.children.end());
    }
  }

  /// Appends the nodes with their lengths from the start. A goal that was not reached is left out.
  void AddNodes(std::vector<TreeNode>& tree) const {
    const bool reached = nodes_[kGoal].cost < kNoCurve;
    const auto place = [&](std::size_t node) { return node > kGoal && !reached ? node - 1 : node; };
    tree.resize(reached ? nodes_.size() : nodes_.size() - 1);
    std::vector<std::size_t> open{kStart};
    while (!open.empty()) {
      const Node& at = nodes_[open.back()];
      const TreeNode& parent = tree[place(at.parent)];
      tree[place(open.back())] = {at.pose.position(), place(at.parent), parent.cost + at.length};
      open.pop_back();
      open.insert(open.end(), at.children.begin(), at.children.end());
    }
  }

  LegFinder& finder_;
  const CurveTreeProblem& problem_;
  boost::random::mt19937_64 random_;
  std::vector<Node> nodes_;
  NodeGrid index_;
  std::vector<NodeGrid::Near> near_;  // Nodes found by the last neighbor query.
  std::vector<Neighbor> neighbors_;   // Possible parents of the node being added.
};

}  // namespace

CurveTreeResult GrowCurveTree(LegFinder& finder, const CurveTreeProblem& problem,
                              std::uint64_t seed) {
  return CurveTree(finder, problem, seed).Grow();
}

}  // namespace trackbed
