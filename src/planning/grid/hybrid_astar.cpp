#include "trackbed/planning/grid/hybrid_astar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <queue>
#include <unordered_map>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"
#include "trackbed/planning/grid/astar.h"

// Hybrid A* (Dolgov et al. 2008) searches over poses that a car can reach, forwards and in reverse.
// The heuristic is the larger of the Reeds-Shepp (or Dubins) length and the grid distance.
// Dijkstra's algorithm computes the grid distance around the obstacles. To expand a node, the
// search drives arcs of curvature 0, +-1/(2r) and +-1/r forwards and in reverse. The search keeps
// only the cheapest node per cell of position, heading and direction. The nearer a node is to the
// goal, the more often the search tries a collision-free curve to the goal. The search ends when
// the cheapest open node is at the goal, reached by a collision-free curve.

namespace trackbed {
namespace {

/// Largest ratio of the length of a path on the eight-neighbor grid to the length of the straight
/// line: 1/cos(pi/8).
constexpr double kOctileOverStraight = 1.0823922002923940;

/// A pose that the search has reached.
struct Node {
  Pose2 pose;
  double cost = 0.0;
  int parent = -1;
  Segment step;  ///< Path segment that ends at this pose; empty for the start.
  /// Index of the curve that leads to the goal if this node is at the goal; otherwise -1.
  int last_curve = -1;
};

struct Open {
  double estimate;
  int node;

  /// Orders the open nodes: the node with the lowest estimate comes first, and among nodes with
  /// equal estimates the newest node.
  bool operator<(const Open& other) const {
    return estimate != other.estimate ? estimate > other.estimate : node < other.node;
  }
};

class HybridAStar {
 public:
  HybridAStar(const VehicleParams& vehicle, const HybridAStarProblem& problem,
              const HybridAStarOptions& options)
      : vehicle_(vehicle),
        options_(options),
        problem_(problem),
        radius_(options.radius.value_or(1.1 * vehicle.min_turning_radius())),
        clear_(vehicle, problem.obstacles, options.safe_distance),
        grid_(MakeGrid(vehicle)) {}

  HybridAStarResult Run() {
    HybridAStarResult result;
    if (grid_.size() == 0) {
      return Fail(result, PlanStatus::kBudgetUsedUp,
                  fmt::format("more than {:.3g} cells of {:.3g} m", kMaxCells, options_.cell));
    }
    result.cells = static_cast<int>(grid_.size());
    if (!clear_.IsFree(problem_.start)) {
      return Fail(result, PlanStatus::kStartBlocked, "the start is too close to an obstacle");
    }
    if (!clear_.IsFree(problem_.goal)) {
      return Fail(result, PlanStatus::kGoalBlocked, "the goal is too close to an obstacle");
    }
    const int goal_cell = grid_.CellAt(problem_.goal.position());
    distances_ = DistancesTo(grid_, static_cast<std::size_t>(goal_cell));
    if (!std::isfinite(LeftOnGrid(problem_.start))) {
      return Fail(result, PlanStatus::kNoPath, "obstacles enclose the start or the goal");
    }
    nodes_.push_back({.pose = problem_.start});
    open_.push({options_.weight * Left(problem_.start), 0});
    while (!open_.empty()) {
      const int index = open_.top().node;
      const Node node = nodes_[static_cast<std::size_t>(index)];
      if (node.last_curve >= 0) {
        return Found(result, index);
      }
      open_.pop();
      if (node.parent >= 0 && best_.at(NodeKey(node)) < node.cost) {
        continue;  // the search has since found a cheaper path to this cell
      }
      if (result.expansions >= options_.budget) {
        return BudgetUsedUp(result);
      }
      ++result.expansions;
      Expand(index, node, result.expansions);
    }
    return Fail(result, PlanStatus::kNoPath, "no feasible path");
  }

 private:
  static HybridAStarResult Fail(HybridAStarResult& result, PlanStatus status,
                                const std::string& reason) {
    result.status = status;
    result.reason = reason;
    return result;
  }

  /// Makes a grid in which a cell is occupied if the rear-axle center cannot be at any point of the
  /// cell. In such a cell, every point is closer to an obstacle than the permitted minimum: the
  /// distance from the rear-axle center to the nearest side of the footprint, plus the safe
  /// distance. Returns an empty grid if the area has too many cells.
  [[nodiscard]] OccupancyGrid MakeGrid(const VehicleParams& vehicle) const {
    const GridArea area =
        AreaAround(problem_.start, {problem_.start.position(), problem_.goal.position()},
                   problem_.obstacles, options_.margin);
    if (CellsIn(area, options_.cell) > kMaxCells) {
      return {};
    }
    const double nearest_side = std::min(
        {0.5 * vehicle.width, vehicle.rear_overhang, vehicle.length - vehicle.rear_overhang});
    const double inflation =
        nearest_side + options_.safe_distance - 0.5 * std::sqrt(2.0) * options_.cell;
    return Rasterize(problem_.start, area, options_.cell, problem_.obstacles,
                     std::max(inflation, 0.0));
  }

  /// Returns a lower bound of the remaining distance to the goal, computed from the distance on the
  /// grid [m].
  [[nodiscard]] double LeftOnGrid(const Pose2& pose) const {
    const int cell = grid_.CellAt(pose.position());
    if (cell < 0) {
      return std::numeric_limits<double>::infinity();
    }
    // Points of two cells may be closer together than the cells' centers, by up to the diagonal of
    // a cell.
    const double steps = distances_[static_cast<std::size_t>(cell)] / kOctileOverStraight;
    return options_.cell * std::max(steps - std::sqrt(2.0), 0.0);
  }

  [[nodiscard]] double Left(const Pose2& pose) const {
    const double curve = options_.reverse ? ReedsSheppLength(pose, problem_.goal, radius_)
                                          : Dubins(pose, problem_.goal, radius_).length;
    return std::max(LeftOnGrid(pose), curve);
  }

  /// Returns the key of the cell of position, heading and direction of motion that contains a node.
  [[nodiscard]] std::int64_t NodeKey(const Node& node) const {
    const std::int64_t cell = grid_.CellAt(node.pose.position());
    const double turn = WrapAngle(node.pose.yaw - problem_.start.yaw) / (2.0 * kPi);
    std::int64_t heading = std::llround(turn * options_.headings);
    heading = (heading + options_.headings) % options_.headings;
    return (cell * options_.headings + heading) * 2 + (node.step.direction > 0 ? 1 : 0);
  }

  /// Returns the cost of a segment, including the changes of direction and steering after the
  /// previous segment.
  [[nodiscard]] double StepCost(const Segment& before, const Segment& segment) const {
    double cost = segment.length * (segment.direction > 0 ? 1.0 : options_.reverse_cost);
    if (before.length > 0.0) {
      cost += before.direction != segment.direction ? options_.switch_cost : 0.0;
      cost += options_.steering_cost * radius_ * std::abs(segment.curvature - before.curvature);
    }
    return cost;
  }

  [[nodiscard]] bool MustGoForwards(const Node& node) const {
    return problem_.rolls && node.parent < 0;
  }

  void Expand(int index, const Node& node, int expansions) {
    // Try a curve to the goal more often near the goal: if n turning radii remain to the goal, try
    // at every (n + 1)-th expansion.
    const double left = Left(node.pose);
    if (expansions % (1 + static_cast<int>(left / radius_)) == 0 || expansions == 1) {
      TryToEnd(index, node);
    }
    // Length of an arc, longer than a cell's diagonal so that the arc leaves the cell.
    const double length = 1.5 * options_.cell;
    for (const int direction : {1, -1}) {
      if (direction < 0 && (!options_.reverse || MustGoForwards(node))) {
        continue;
      }
      for (const double bend : {0.0, 0.5, -0.5, 1.0, -1.0}) {
        const Segment step{.length = length, .curvature = bend / radius_, .direction = direction};
        const double along = direction * length;
        Node child{.pose = MoveOnArc(node.pose, along, step.curvature * along),
                   .cost = node.cost + StepCost(node.step, step),
                   .parent = index,
                   .step = step};
        if (!std::isfinite(LeftOnGrid(child.pose))) {
          continue;
        }
        const auto [best, is_new] = best_.try_emplace(NodeKey(child), child.cost);
        if ((!is_new && best->second <= child.cost) || !clear_.IsFree(node.pose, step)) {
          if (is_new) {
            best_.erase(best);
          }
          continue;
        }
        best->second = child.cost;
        Push(child, child.cost + options_.weight * Left(child.pose));
      }
    }
  }

  void Push(const Node& node, double estimate) {
    open_.push({estimate, static_cast<int>(nodes_.size())});
    nodes_.push_back(node);
  }

  /// Tries to reach the goal by the cheapest collision-free curve among the few cheapest curves.
  void TryToEnd(int index, const Node& node) {
    constexpr std::size_t kMaxAttempts = 4;
    struct Curve {
      ShortestCurve word;
      std::vector<Segment> segments;
      double cost;
    };
    std::vector<Curve> curves;
    for (const ShortestCurve& word : options_.reverse
                                         ? ReedsSheppWords(node.pose, problem_.goal, radius_)
                                         : DubinsWords(node.pose, problem_.goal, radius_)) {
      Curve curve{word, ToSegments(word), 0.0};
      curve.cost = EndCost(node, curve.segments);
      const bool backwards = !curve.segments.empty() && curve.segments.front().direction < 0;
      if (curve.cost < best_end_ && !(backwards && MustGoForwards(node))) {
        curves.push_back(std::move(curve));
      }
    }
    std::stable_sort(curves.begin(), curves.end(),
                     [](const Curve& a, const Curve& b) { return a.cost < b.cost; });
    curves.resize(std::min(curves.size(), kMaxAttempts));
    for (Curve& curve : curves) {
      std::vector<Segment> gentle = GentlerPieces(node, curve.word);
      if (gentle != curve.segments && IsFree(node.pose, gentle)) {
        curve.cost = EndCost(node, gentle);
        curve.segments = std::move(gentle);
      } else if (!IsFree(node.pose, curve.segments)) {
        continue;
      }
      if (curve.cost < best_end_) {
        best_end_ = curve.cost;
        Push({.pose = problem_.goal,
              .cost = curve.cost,
              .parent = index,
              .step = {},
              .last_curve = static_cast<int>(last_curves_.size())},
             curve.cost);
        last_curves_.push_back(std::move(curve.segments));
        return;
      }
    }
  }

  /// The cost of a path that ends with a curve from a node.
  [[nodiscard]] double EndCost(const Node& node, const std::vector<Segment>& curve) const {
    double cost = node.cost;
    const Segment* before = &node.step;
    for (const Segment& segment : curve) {
      cost += StepCost(*before, segment);
      before = &segment;
    }
    return cost;
  }

  /// Whether the car would have to stop in a curve from a node to turn its wheels.
  [[nodiscard]] bool HasStop(const Node& node, const std::vector<Segment>& curve) const {
    std::vector<Segment> path;
    if (node.parent >= 0) {
      path.push_back(node.step);
    }
    AppendPieces(path, curve);
    return !PlanSteps(vehicle_, path, problem_.drive->min_speed).stops.empty();
  }

  /// The pieces of a last curve: without short arcs, if that costs no more or saves a stop.
  [[nodiscard]] std::vector<Segment> GentlerPieces(const Node& node,
                                                   const ShortestCurve& word) const {
    std::vector<Segment> shortest = ToSegments(word);
    if (!problem_.drive) {
      return shortest;
    }
    CurveDrive drive = *problem_.drive;
    if (node.parent >= 0) {
      drive.before = {node.step.curvature, node.step.direction};
    }
    std::vector<Segment> gentle = DrivablePieces(vehicle_, node.pose, problem_.goal, word, drive);
    const bool is_better =
        EndCost(node, gentle) <= EndCost(node, shortest) || HasStop(node, shortest);
    return is_better ? gentle : shortest;
  }

  [[nodiscard]] bool IsFree(Pose2 pose, const std::vector<Segment>& segments) const {
    for (const Segment& segment : segments) {
      if (!clear_.IsFree(pose, segment)) {
        return false;
      }
      const double along = segment.direction * segment.length;
      pose = MoveOnArc(pose, along, segment.curvature * along);
    }
    return true;
  }

  HybridAStarResult Found(HybridAStarResult& result, int index) const {
    std::vector<Segment> backwards;
    const Node& goal = nodes_[static_cast<std::size_t>(index)];
    const auto& last = last_curves_[static_cast<std::size_t>(goal.last_curve)];
    std::copy(last.rbegin(), last.rend(), std::back_inserter(backwards));
    for (int i = goal.parent; nodes_[static_cast<std::size_t>(i)].parent >= 0;) {
      const Node& node = nodes_[static_cast<std::size_t>(i)];
      backwards.push_back(node.step);
      i = node.parent;
    }
    for (auto step = backwards.rbegin(); step != backwards.rend(); ++step) {
      Segment* before = result.segments.empty() ? nullptr : &result.segments.back();
      if (before != nullptr && before->curvature == step->curvature &&
          before->direction == step->direction) {
        before->length += step->length;
      } else {
        result.segments.push_back(*step);
      }
    }
    result.status = PlanStatus::kOk;
    result.cost = goal.cost;
    return result;
  }

  /// Returns the cheapest path to the goal found so far, or the failure.
  HybridAStarResult BudgetUsedUp(HybridAStarResult& result) const {
    for (std::size_t i = nodes_.size(); i-- > 0;) {
      if (nodes_[i].last_curve >= 0) {
        return Found(result, static_cast<int>(i));  // the last path found is the cheapest path
      }
    }
    return Fail(result, PlanStatus::kBudgetUsedUp,
                fmt::format("no path found in {} expansions", result.expansions));
  }

  const VehicleParams& vehicle_;
  const HybridAStarOptions& options_;
  const HybridAStarProblem& problem_;
  double radius_;
  CollisionChecker clear_;
  OccupancyGrid grid_;
  std::vector<double> distances_;  // Distances to the goal on the grid.
  std::vector<Node> nodes_;
  std::priority_queue<Open> open_;
  std::unordered_map<std::int64_t, double> best_;  // Cost of the cheapest known node in each cell.
  double best_end_ = std::numeric_limits<double>::infinity();
  std::vector<std::vector<Segment>> last_curves_;
};

}  // namespace

HybridAStarResult SearchHybridAStar(const VehicleParams& vehicle, const HybridAStarProblem& problem,
                                    const HybridAStarOptions& options) {
  TRACKBED_CHECK(options.cell > 0.0 && options.headings >= 8 && options.margin >= 0.0 &&
                     options.budget >= 0 && options.radius.value_or(1.0) > 0.0 &&
                     options.weight >= 1.0 && options.reverse_cost >= 1.0 &&
                     options.switch_cost >= 0.0 && options.steering_cost >= 0.0,
                 "cells of {} m and {} headings, margin {}, budget {}, costs {}, {}, {}",
                 options.cell, options.headings, options.margin, options.budget,
                 options.reverse_cost, options.switch_cost, options.steering_cost);
  return HybridAStar(vehicle, problem, options).Run();
}

}  // namespace trackbed
