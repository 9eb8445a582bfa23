#include "trackbed/planning/sampling/rrt_star.h"

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <limits>

#include "src/planning/sampling/node_grid.h"
#include "trackbed/core/error.h"
#include "trackbed/geometry/box_index.h"

// Implements the k-nearest form of RRT* (Karaman and Frazzoli 2011) for a point in the plane. For
// each random sample, the tree grows from the nearest node toward the sample by at most one step.
// The parent of the new node is the cheapest neighbor with a free edge. Neighbors whose paths are
// cheaper through the new node are rewired, and the costs of their descendants are updated.
// Informed sampling rejects nodes that cannot shorten the best path (Gammell et al. 2014). NodeGrid
// is the index for neighbor queries.

namespace trackbed {
namespace {

// Factor in the number of neighbors, chosen a tenth above its lower bound 2^(d+1) e (1 + 1/d) for d
// = 2 dimensions.
constexpr double kNeighbors = 1.1 * 12.0 * 2.718281828459045;
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

class RrtStarTree {
 public:
  RrtStarTree(const RrtStarProblem& problem, const RrtStarOptions& options, std::uint64_t seed)
      : problem_(problem),
        obstacles_(problem.obstacles),
        options_(options),
        random_(seed),
        index_(problem.low, problem.high) {
    Add(problem.start, 0, 0.0);
  }

  RrtStarResult Grow() {
    RrtStarResult result;
    result.cost = std::numeric_limits<double>::infinity();
    if (!IsFree(problem_.start, problem_.start)) {
      result.status = RrtStarStatus::kStartBlocked;
    } else if (!IsFree(problem_.goal, problem_.goal)) {
      result.status = RrtStarStatus::kGoalBlocked;
    } else {
      while (result.iterations < options_.iterations) {
        ++result.iterations;
        Iterate();
        if (options_.stop && options_.stop()) {
          break;
        }
      }
    }
    if (goal_ != kNone) {
      result.status = RrtStarStatus::kFound;
      result.cost = nodes_[goal_].cost;
      for (std::size_t node = goal_; node != 0; node = nodes_[node].parent) {
        result.path.push_back(nodes_[node].position);
      }
      result.path.push_back(problem_.start);
      std::reverse(result.path.begin(), result.path.end());
    }
    result.nodes = std::move(nodes_);
    return result;
  }

 private:
  struct Neighbor {
    std::size_t node;
    double distance;
    double cost;  // cost of the new node through this neighbor
  };

  double Uniform() { return boost::random::uniform_01<double>()(random_); }

  [[nodiscard]] bool IsFree(const Vec2& from, const Vec2& to) const {
    return obstacles_.KeepsFrom(from, to, problem_.inflation);
  }

  Vec2 Sample() {
    // Always draw three random numbers, so that the sequence of samples does not depend on whether
    // the goal is reached.
    const double bias = Uniform();
    const double x = Uniform();
    const double y = Uniform();
    if (goal_ == kNone && bias < options_.goal_bias) {
      return problem_.goal;
    }
    return {std::lerp(problem_.low.x(), problem_.high.x(), x),
            std::lerp(problem_.low.y(), problem_.high.y(), y)};
  }

  void Iterate() {
    const Vec2 sample = Sample();
    const std::size_t from = index_.Nearest(sample);
    const Vec2 nearest = nodes_[from].position;
    const Vec2 offset = sample - nearest;
    const double distance = offset.norm();
    if (distance == 0.0) {
      if (goal_ == kNone && sample == problem_.goal) {
        goal_ = from;  // the start is the goal
      }
      return;
    }
    const bool reaches = distance <= options_.step;
    const Vec2 position = reaches ? sample : Vec2(nearest + offset * (options_.step / distance));
    if ((options_.informed && !MayShorten(position)) || !IsFree(nearest, position)) {
      return;
    }
    const std::size_t node = Join(position, from);
    if (goal_ == kNone) {
      if (reaches && sample == problem_.goal) {
        goal_ = node;
      } else if ((position - problem_.goal).norm() <= options_.step &&
                 IsFree(position, problem_.goal)) {
        goal_ = Join(problem_.goal, node);
      }
    }
  }

  /// Returns whether a path through the point `p` can be shorter than the best path so far.
  [[nodiscard]] bool MayShorten(const Vec2& p) const {
    return goal_ == kNone ||
           (p - problem_.start).norm() + (p - problem_.goal).norm() < nodes_[goal_].cost;
  }

  /// Adds a node with its cheapest neighbor as parent, and rewires neighbors through the new node.
  /// The edge to the node `reached_from` must be free.
  std::size_t Join(const Vec2& position, std::size_t reached_from) {
    const double count = static_cast<double>(nodes_.size());
    const double nearest = std::ceil(kNeighbors * std::log(count + 1.0));
    index_.FindNearest(position, static_cast<std::size_t>(nearest), near_);
    const double reached = (nodes_[reached_from].position - position).norm();
    const Neighbor first{reached_from, reached, nodes_[reached_from].cost + reached};
    neighbors_ = {first};
    cheaper_.clear();
    for (const auto& [square, node] : near_) {
      const double distance = std::sqrt(square);
      const Neighbor neighbor{node, distance, nodes_[node].cost + distance};
      if (node != reached_from) {
        neighbors_.push_back(neighbor);
      }
      if (CostsLess(neighbor, first)) {
        cheaper_.push_back(neighbor);
      }
    }
    const Neighbor parent = Cheapest(position, first);
    const std::size_t node = Add(position, parent.node, parent.cost);
    // Drop the neighbors that are not cheaper through the new node. Later rewiring cannot make a
    // dropped neighbor cheaper through the new node, because rewiring only lowers costs.
    const auto last = std::remove_if(neighbors_.begin(), neighbors_.end(), [&](const Neighbor& of) {
      return parent.cost + of.distance >= nodes_[of.node].cost;
    });
    std::sort(neighbors_.begin(), last, CostsLess);
    for (auto other = neighbors_.begin(); other != last; ++other) {
      const double cost = parent.cost + other->distance;
      if (cost < nodes_[other->node].cost && IsFree(position, nodes_[other->node].position)) {
        Rejoin(other->node, node, cost);
      }
    }
    return node;
  }

  static bool CostsLess(const Neighbor& a, const Neighbor& b) {
    return a.cost < b.cost || (a.cost == b.cost && a.node < b.node);
  }

  /// Returns the cheapest neighbor in cheaper_ whose edge to `position` is free, or `otherwise`.
  /// Reorders cheaper_ as a heap, because usually only few edges need a check and sorting hundreds
  /// of candidates would take longer.
  Neighbor Cheapest(const Vec2& position, const Neighbor& otherwise) {
    const auto costs_more = [](const Neighbor& a, const Neighbor& b) { return CostsLess(b, a); };
    std::make_heap(cheaper_.begin(), cheaper_.end(), costs_more);
    for (auto end = cheaper_.end(); end != cheaper_.begin(); --end) {
      const Neighbor cheapest = cheaper_.front();
      if (IsFree(nodes_[cheapest.node].position, position)) {
        return cheapest;
      }
      std::pop_heap(cheaper_.begin(), end, costs_more);
    }
    return otherwise;
  }

  std::size_t Add(const Vec2& position, std::size_t parent, double cost) {
    const std::size_t node = nodes_.size();
    nodes_.push_back({position, parent, cost});
    children_.emplace_back();
    if (node != parent) {
      children_[parent].push_back(node);
    }
    index_.Add(position, node);
    return node;
  }

  void Rejoin(std::size_t node, std::size_t parent, double cost) {
    std::vector<std::size_t>& siblings = children_[nodes_[node].parent];
    siblings.erase(std::find(siblings.begin(), siblings.end(), node));
    children_[parent].push_back(node);
    nodes_[node].parent = parent;
    nodes_[node].cost = cost;
    // Update the costs of all descendants.
    std::vector<std::size_t> open{node};
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      for (const std::size_t child : children_[at]) {
        nodes_[child].cost =
            nodes_[at].cost + (nodes_[child].position - nodes_[at].position).norm();
        open.push_back(child);
      }
    }
  }

  const RrtStarProblem& problem_;
  BoxIndex obstacles_;
  const RrtStarOptions& options_;
  boost::random::mt19937_64 random_;
  std::vector<TreeNode> nodes_;
  std::vector<std::vector<std::size_t>> children_;
  NodeGrid index_;
  std::size_t goal_ = kNone;
  std::vector<NodeGrid::Near> near_;  // Nodes found by the last neighbor query.
  std::vector<Neighbor> neighbors_;   // Neighbors of the node being added.
  // Neighbors through which the new node costs less than through the extended node.
  std::vector<Neighbor> cheaper_;
};

bool IsWithin(const RrtStarProblem& problem, const Vec2& p) {
  return problem.low.allFinite() && problem.high.allFinite() &&
         (p.array() >= problem.low.array()).all() && (p.array() <= problem.high.array()).all();
}

}  // namespace

const char* ToString(RrtStarStatus status) {
  switch (status) {
    case RrtStarStatus::kFound:
      return "found";
    case RrtStarStatus::kNotReached:
      return "not_reached";
    case RrtStarStatus::kStartBlocked:
      return "start_blocked";
    case RrtStarStatus::kGoalBlocked:
      return "goal_blocked";
  }
  return "unknown";
}

RrtStarResult PlanRrtStar(const RrtStarProblem& problem, const RrtStarOptions& options,
                          std::uint64_t seed) {
  TRACKBED_CHECK(IsWithin(problem, problem.start) && IsWithin(problem, problem.goal),
                 "start ({}, {}) or goal ({}, {}) outside a finite box", problem.start.x(),
                 problem.start.y(), problem.goal.x(), problem.goal.y());
  TRACKBED_CHECK(options.iterations >= 0 && options.step >= 0.0 && options.goal_bias >= 0.0 &&
                     options.goal_bias <= 1.0 && problem.inflation.most >= 0.0,
                 "iterations {}, step {}, goal bias {}, inflation {}", options.iterations,
                 options.step, options.goal_bias, problem.inflation.most);
  RrtStarOptions filled = options;
  if (options.step == 0.0) {
    filled.step = 0.2 * (problem.high - problem.low).norm();
  }
  return RrtStarTree(problem, filled, seed).Grow();
}

}  // namespace trackbed
