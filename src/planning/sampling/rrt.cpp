#include "trackbed/planning/sampling/rrt.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <optional>

#include "trackbed/core/error.h"
#include "trackbed/geometry/box_index.h"

namespace trackbed {
namespace {

namespace index = boost::geometry::index;
using Point = boost::geometry::model::d2::point_xy<double>;
using Entry = std::pair<Point, std::size_t>;

class Tree {
 public:
  Tree(const RrtProblem& problem, const RrtOptions& options, std::uint64_t seed)
      : problem_(problem), obstacles_(problem.obstacles), options_(options), random_(seed) {
    Add(problem.start, 0);
  }

  RrtResult Grow() {
    RrtResult result;
    if (!IsFree(problem_.start, problem_.start)) {
      result.status = RrtStatus::kStartBlocked;
    } else if (!IsFree(problem_.goal, problem_.goal)) {
      result.status = RrtStatus::kGoalBlocked;
    } else {
      std::optional<std::size_t> goal = TryGoal(0);
      while (!goal && result.iterations < options_.iterations) {
        if (options_.stop && options_.stop()) {
          result.status = RrtStatus::kStopped;
          break;
        }
        ++result.iterations;
        goal = Iterate();
      }
      if (goal) {
        result.status = RrtStatus::kReached;
      }
      Trace(goal.value_or(Nearest(problem_.goal)), result);
    }
    result.nodes = std::move(nodes_);
    return result;
  }

 private:
  double Uniform() { return boost::random::uniform_01<double>()(random_); }

  [[nodiscard]] bool IsFree(const Vec2& from, const Vec2& to) const {
    return obstacles_.KeepsFrom(from, to, problem_.inflation);
  }

  Vec2 Sample() {
    const double bias = Uniform();
    if (bias < options_.goal_bias) {
      return problem_.goal;
    }
    const double x = Uniform();
    const double y = Uniform();
    return {std::lerp(problem_.low.x(), problem_.high.x(), x),
            std::lerp(problem_.low.y(), problem_.high.y(), y)};
  }

  [[nodiscard]] std::size_t Nearest(const Vec2& p) const {
    return index_.qbegin(index::nearest(Point(p.x(), p.y()), 1))->second;
  }

  /// Extends the tree toward one random sample. Returns the goal's node if the tree has reached the
  /// goal.
  std::optional<std::size_t> Iterate() {
    const Vec2 sample = Sample();
    const std::size_t from = Nearest(sample);
    const Vec2 nearest = nodes_[from].position;
    const Vec2 offset = sample - nearest;
    const double distance = offset.norm();
    if (distance == 0.0) {
      return std::nullopt;
    }
    const double step = std::min(distance, options_.expand_distance);
    const Vec2 position = nearest + offset * (step / distance);
    if (!IsFree(nearest, position)) {
      return std::nullopt;
    }
    return TryGoal(Add(position, from));
  }

  /// Adds the goal as a node if the goal is near the given node and the edge between the two is
  /// free.
  std::optional<std::size_t> TryGoal(std::size_t node) {
    const Vec2 position = nodes_[node].position;
    if (position == problem_.goal) {
      return node;
    }
    if ((position - problem_.goal).norm() > options_.expand_distance ||
        !IsFree(position, problem_.goal)) {
      return std::nullopt;
    }
    return Add(problem_.goal, node);
  }

  std::size_t Add(const Vec2& position, std::size_t parent) {
    const std::size_t node = nodes_.size();
    nodes_.push_back({position, parent});
    index_.insert({Point(position.x(), position.y()), node});
    return node;
  }

  /// Stores the path along the tree from the root to a node in `result`.
  void Trace(std::size_t node, RrtResult& result) const {
    for (; node != 0; node = nodes_[node].parent) {
      result.path.push_back(nodes_[node].position);
      result.length += (nodes_[node].position - nodes_[nodes_[node].parent].position).norm();
    }
    result.path.push_back(problem_.start);
    std::reverse(result.path.begin(), result.path.end());
  }

  const RrtProblem& problem_;
  BoxIndex obstacles_;
  const RrtOptions& options_;
  boost::random::mt19937_64 random_;
  std::vector<RrtNode> nodes_;
  index::rtree<Entry, index::linear<16>> index_;
};

bool IsWithin(const RrtProblem& problem, const Vec2& p) {
  return (p.array() >= problem.low.array()).all() && (p.array() <= problem.high.array()).all();
}

}  // namespace

const char* ToString(RrtStatus status) {
  switch (status) {
    case RrtStatus::kReached:
      return "reached";
    case RrtStatus::kIterations:
      return "iterations";
    case RrtStatus::kStopped:
      return "stopped";
    case RrtStatus::kStartBlocked:
      return "start_blocked";
    case RrtStatus::kGoalBlocked:
      return "goal_blocked";
  }
  return "unknown";
}

RrtResult PlanRrt(const RrtProblem& problem, const RrtOptions& options, std::uint64_t seed) {
  TRACKBED_CHECK(IsWithin(problem, problem.start) && IsWithin(problem, problem.goal),
                 "start ({}, {}) or goal ({}, {}) outside the box", problem.start.x(),
                 problem.start.y(), problem.goal.x(), problem.goal.y());
  TRACKBED_CHECK(
      options.iterations >= 0 && options.expand_distance > 0.0 && options.goal_bias >= 0.0 &&
          options.goal_bias <= 1.0 && problem.inflation.most >= 0.0,
      "iterations {}, expand distance {}, goal bias {}, inflation {}", options.iterations,
      options.expand_distance, options.goal_bias, problem.inflation.most);
  return Tree(problem, options, seed).Grow();
}

}  // namespace trackbed
