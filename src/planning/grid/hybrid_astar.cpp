#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <queue>
#include <unordered_map>
#include <utility>

#include "src/planning/grid/pose_search.h"
#include "trackbed/core/angle.h"
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
// the cheapest open node is at the goal, reached by a collision-free curve. A search from the goal
// does the same along the path driven backwards in time, from the goal to the start.

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

class HybridAStar final : public PoseSearch {
 public:
  HybridAStar(const SearchSpace& space, const Resolution& resolution, SearchSide side,
              std::shared_ptr<const GridDistance> left)
      : vehicle_(space.vehicle),
        options_(space.options),
        problem_(space.problem),
        radius_(space.radius),
        clear_(space.clear),
        resolution_(resolution),
        from_start_(side == SearchSide::kStart),
        target_(from_start_ ? problem_.goal : problem_.start),
        left_(std::move(left)) {
    nodes_.push_back({.pose = from_start_ ? problem_.start : problem_.goal});
    open_.push({options_.weight * Left(nodes_.front().pose), 0});
  }

  void Advance() override {
    while (!ended()) {
      const int index = open_.top().node;
      const Node node = nodes_[static_cast<std::size_t>(index)];
      open_.pop();
      if (node.parent < 0 || best_.at(NodeKey(node)) >= node.cost) {
        Expand(index, node, ++expansions_);
        return;
      }
      // The search has since found a cheaper path to this cell.
    }
  }

  [[nodiscard]] bool ended() const override {
    return open_.empty() || nodes_[static_cast<std::size_t>(open_.top().node)].last_curve >= 0;
  }

  [[nodiscard]] int expansions() const override { return expansions_; }

  [[nodiscard]] double cost() const override { return best_end_; }

  [[nodiscard]] std::vector<Segment> Path() const override {
    // The last node with a curve has the cheapest path.
    const auto end = std::find_if(nodes_.rbegin(), nodes_.rend(),
                                  [](const Node& node) { return node.last_curve >= 0; });
    std::vector<Segment> steps;
    if (end == nodes_.rend()) {
      return steps;
    }
    const auto& last = last_curves_[static_cast<std::size_t>(end->last_curve)];
    std::copy(last.rbegin(), last.rend(), std::back_inserter(steps));
    for (int i = end->parent; nodes_[static_cast<std::size_t>(i)].parent >= 0;) {
      const Node& node = nodes_[static_cast<std::size_t>(i)];
      steps.push_back(node.step);
      i = node.parent;
    }
    std::vector<Segment> path;
    // The steps are in the order of the path if the search began at the goal.
    if (from_start_) {
      std::reverse(steps.begin(), steps.end());
    }
    for (Segment& step : steps) {
      step.direction = IsReverse(step) ? -1 : 1;
      Segment* before = path.empty() ? nullptr : &path.back();
      if (before != nullptr && before->curvature == step.curvature &&
          before->direction == step.direction) {
        before->length += step.length;
      } else {
        path.push_back(step);
      }
    }
    return path;
  }

 private:
  [[nodiscard]] double LeftOnGrid(const Pose2& pose) const {
    return left_->LowerBound(pose.position());
  }

  /// Returns the poses at the start and at the end of a curve between a node and the target.
  [[nodiscard]] std::pair<Pose2, Pose2> CurveEnds(const Pose2& node) const {
    return from_start_ ? std::pair(node, target_) : std::pair(target_, node);
  }

  [[nodiscard]] double Left(const Pose2& pose) const {
    const auto [from, to] = CurveEnds(pose);
    const double curve =
        options_.reverse ? ReedsSheppLength(from, to, radius_) : Dubins(from, to, radius_).length;
    return std::max(LeftOnGrid(pose), curve);
  }

  /// Returns the key of the cell of position, heading and direction of motion that contains a node.
  [[nodiscard]] std::uint64_t NodeKey(const Node& node) const {
    // Keys of bins are unique within 2^25 bins of the start.
    const Vec2 local = ToLocal(problem_.start, node.pose.position()) / resolution_.cell;
    const auto column = static_cast<std::uint64_t>(std::llround(local.x()));
    const auto row = static_cast<std::uint64_t>(std::llround(local.y()));
    const double turn = WrapAngle(node.pose.yaw - problem_.start.yaw) / (2.0 * kPi);
    const std::int64_t heading = std::llround(turn * resolution_.headings) + resolution_.headings;
    const auto headings = static_cast<std::uint64_t>(resolution_.headings);
    const std::uint64_t bin =
        ((row << 26) + column) * headings + static_cast<std::uint64_t>(heading) % headings;
    return bin * 2 + (node.step.direction > 0 ? 1 : 0);
  }

  /// Returns whether the car drives a segment of the search backwards.
  [[nodiscard]] bool IsReverse(const Segment& segment) const {
    return (segment.direction < 0) == from_start_;
  }

  /// Returns the cost of a segment, including the changes of direction and steering after the
  /// previous segment.
  [[nodiscard]] double StepCost(const Segment& before, const Segment& segment) const {
    double cost = segment.length * (IsReverse(segment) ? options_.reverse_cost : 1.0);
    if (before.length > 0.0) {
      cost += before.direction != segment.direction ? options_.switch_cost : 0.0;
      cost += options_.steering_cost * radius_ * std::abs(segment.curvature - before.curvature);
    }
    return cost;
  }

  [[nodiscard]] bool MustGoForwards(const Node& node) const {
    return problem_.rolls && from_start_ && node.parent < 0;
  }

  /// Returns whether a curve between a node and the target lets a rolling car begin forwards.
  [[nodiscard]] bool BeginsWell(const Node& node, const std::vector<Segment>& curve) const {
    if (from_start_) {
      return !MustGoForwards(node) || curve.empty() || !IsReverse(curve.front());
    }
    return !problem_.rolls || !IsReverse(curve.empty() ? node.step : curve.back());
  }

  void Expand(int index, const Node& node, int expansions) {
    // Try a curve to the goal more often near the goal: if n turning radii remain to the goal, try
    // at every (n + 1)-th expansion.
    const double left = Left(node.pose);
    if (expansions % (1 + static_cast<int>(left / radius_)) == 0 || expansions == 1) {
      TryToEnd(index, node);
    }
    for (const int direction : {1, -1}) {
      for (const double bend : {0.0, 0.5, -0.5, 1.0, -1.0}) {
        const Segment step{
            .length = resolution_.step, .curvature = bend / radius_, .direction = direction};
        if (IsReverse(step) && (!options_.reverse || MustGoForwards(node))) {
          break;
        }
        const double along = direction * step.length;
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

  /// Returns the segments of a path in the order and in the directions of the search. The function
  /// is its own inverse.
  [[nodiscard]] std::vector<Segment> InSearchOrder(std::vector<Segment> segments) const {
    if (!from_start_) {
      std::reverse(segments.begin(), segments.end());
      for (Segment& segment : segments) {
        segment.direction = -segment.direction;
      }
    }
    return segments;
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
    const auto [from, to] = CurveEnds(node.pose);
    for (const ShortestCurve& word :
         options_.reverse ? ReedsSheppWords(from, to, radius_) : DubinsWords(from, to, radius_)) {
      Curve curve{word, InSearchOrder(ToSegments(word)), 0.0};
      curve.cost = EndCost(node, curve.segments);
      if (curve.cost < best_end_ && BeginsWell(node, curve.segments)) {
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
        Push({.pose = target_,
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
    std::vector<Segment> pieces;
    if (node.parent >= 0) {
      pieces.push_back(node.step);
    }
    pieces.insert(pieces.end(), curve.begin(), curve.end());
    std::vector<Segment> path;
    AppendPieces(path, InSearchOrder(std::move(pieces)));
    return !PlanSteps(vehicle_, path, problem_.drive->min_speed).stops.empty();
  }

  /// The pieces of a last curve: without short arcs, if that costs no more or saves a stop.
  [[nodiscard]] std::vector<Segment> GentlerPieces(const Node& node,
                                                   const ShortestCurve& word) const {
    std::vector<Segment> shortest = InSearchOrder(ToSegments(word));
    if (!problem_.drive) {
      return shortest;
    }
    CurveDrive drive = *problem_.drive;
    if (node.parent >= 0) {
      PathBend& bend = from_start_ ? drive.before : drive.after;
      bend = {node.step.curvature, IsReverse(node.step) ? -1 : 1};
    }
    const auto [from, to] = CurveEnds(node.pose);
    std::vector<Segment> gentle = InSearchOrder(DrivablePieces(vehicle_, from, to, word, drive));
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

  const VehicleParams& vehicle_;
  const HybridAStarOptions& options_;
  const HybridAStarProblem& problem_;
  double radius_;
  const CollisionChecker& clear_;
  Resolution resolution_;
  bool from_start_;
  Pose2 target_;
  std::shared_ptr<const GridDistance> left_;
  std::vector<Node> nodes_;
  std::priority_queue<Open> open_;
  std::unordered_map<std::uint64_t, double> best_;  // Cost of the cheapest known node in each cell.
  int expansions_ = 0;
  double best_end_ = std::numeric_limits<double>::infinity();
  std::vector<std::vector<Segment>> last_curves_;
};

}  // namespace

GridDistance::GridDistance(std::shared_ptr<const OccupancyGrid> grid, const Vec2& target)
    : grid_(std::move(grid)),
      distances_(DistancesTo(*grid_, static_cast<std::size_t>(grid_->CellAt(target)))) {}

double GridDistance::LowerBound(const Vec2& point) const {
  const int cell = grid_->CellAt(point);
  if (cell < 0) {
    return std::numeric_limits<double>::infinity();
  }
  // Points of two cells may be closer together than the cells' centers, by up to the diagonal of a
  // cell.
  const double steps = distances_[static_cast<std::size_t>(cell)] / kOctileOverStraight;
  return grid_->cell * std::max(steps - std::sqrt(2.0), 0.0);
}

Resolution Resolution::WithBins(double cell, int headings, double radius) {
  return {.cell = cell,
          .headings = headings,
          .step = std::max(1.5 * cell, 2.0 * kPi * radius / headings)};
}

std::unique_ptr<PoseSearch> MakePoseSearch(const SearchSpace& space, const Resolution& resolution,
                                           SearchSide side,
                                           std::shared_ptr<const GridDistance> left) {
  return std::make_unique<HybridAStar>(space, resolution, side, std::move(left));
}

}  // namespace trackbed
