#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <queue>
#include <unordered_map>
#include <utility>
#include <vector>

#include "src/planning/grid/pose_search.h"

namespace trackbed {

/// Returns the segments of a path that is driven backwards in time, from its end to its start.
std::vector<Segment> Reversed(std::vector<Segment> segments);

/// A search that keeps its poses in a tree. The derived classes define the steps between poses, the
/// costs of these steps, and the curves that lead to the target.
///
/// Segments are in the order and in the directions of the search. A search from the goal drives
/// the path backwards in time: its segments have the opposite directions.
class PoseTree : public PoseSearch {
 public:
  PoseTree(const SearchSpace& space, const Resolution& resolution, SearchSide side,
           std::shared_ptr<const GridDistance> left);

  void Advance() override;
  [[nodiscard]] bool ended() const override {
    return open_.empty() || nodes_[static_cast<std::size_t>(open_.top().node)].last_curve >= 0 ||
           expansions_ >= last_expansion_;
  }
  [[nodiscard]] int expansions() const override { return expansions_; }
  [[nodiscard]] double cost() const override { return best_end_; }
  [[nodiscard]] std::vector<Segment> Path() const override;

 protected:
  /// A pose that the search has reached.
  struct Node {
    Pose2 pose;
    double curvature = 0.0;  // Curvature at the pose, for paths of continuous curvature [1/m].
    double cost = 0.0;
    double length = 0.0;  // Length of the path from the root of the tree [m].
    int parent = -1;
    Segment step;  // Segment that ends at this pose; empty for the root.
    /// Index of the curve that leads to the target if this node is at the target; otherwise -1.
    int last_curve = -1;
  };

  /// A step from a node.
  struct Step {
    Segment segment;
    double end_curvature = 0.0;  // Curvature at the end, for paths of continuous curvature [1/m].
  };

  /// Returns the steps from a node that the car may drive.
  [[nodiscard]] virtual std::vector<Step> Steps(const Node& node) const = 0;

  /// Returns the cost of a segment, including the changes of direction and steering after the
  /// previous segment.
  [[nodiscard]] virtual double StepCost(const Segment& before, const Segment& segment) const = 0;

  /// Returns the pose at the end of a segment.
  [[nodiscard]] virtual Pose2 EndOf(const Pose2& pose, const Segment& segment) const = 0;

  /// Returns whether the car is clear of obstacles along a segment.
  [[nodiscard]] virtual bool IsFree(const Pose2& pose, const Segment& segment) const = 0;

  /// Returns the bin of the curvature of a node, 0 to 7.
  [[nodiscard]] virtual std::uint64_t CurvatureBin(const Node& node) const = 0;

  /// Tries to reach the target from a node by a curve that is clear of obstacles.
  virtual void TryToEnd(int index, const Node& node) = 0;

  /// Adds a path that reaches the target from the node `index`.
  void AddEnd(int index, double cost, std::vector<Segment> curve);

  /// Lets the search end after `expansions` more expansions, even if paths may become cheaper.
  void EndAfter(int expansions) {
    last_expansion_ = std::min(last_expansion_, expansions_ + expansions);
  }

  /// Returns the cost of a path that ends with a curve from a node.
  [[nodiscard]] double EndCost(const Node& node, const std::vector<Segment>& curve) const;

  [[nodiscard]] bool IsFree(Pose2 pose, const std::vector<Segment>& segments) const;

  /// Returns the segments of a path in the order and in the directions of the search. Applied
  /// twice, InSearchOrder returns the original segments.
  [[nodiscard]] std::vector<Segment> InSearchOrder(std::vector<Segment> segments) const;

  /// Returns the segments from the root to a node, in the order of the search.
  [[nodiscard]] std::vector<Segment> StepsTo(int index) const;

  /// Returns the poses at the start and at the end of a curve between a node and the target.
  [[nodiscard]] std::pair<Pose2, Pose2> CurveEnds(const Pose2& node) const {
    return from_start_ ? std::pair(node, target_) : std::pair(target_, node);
  }

  /// Returns whether the car drives a segment of the search backwards.
  [[nodiscard]] bool IsReverse(const Segment& segment) const {
    return (segment.direction < 0) == from_start_;
  }

  /// Returns whether the car must drive forwards from a node: the node is the start pose, and the
  /// car rolls at the start.
  [[nodiscard]] bool MustGoForwards(const Node& node) const {
    return problem_.rolls && from_start_ && node.parent < 0;
  }

  /// Returns whether a rolling car drives the curve between a node and the target forwards at
  /// first.
  [[nodiscard]] bool BeginsWell(const Node& node, const std::vector<Segment>& curve) const;

  const VehicleParams& vehicle_;
  const HybridAStarOptions& options_;
  const HybridAStarProblem& problem_;
  double radius_;
  const CollisionChecker& clear_;
  Resolution resolution_;
  bool from_start_;
  double best_end_ = std::numeric_limits<double>::infinity();

 private:
  struct Open {
    double estimate;
    int node;

    /// Orders the open nodes: the node with the lowest estimate comes first, and among nodes with
    /// equal estimates the newest node.
    bool operator<(const Open& other) const {
      return estimate != other.estimate ? estimate > other.estimate : node < other.node;
    }
  };

  [[nodiscard]] double LeftOnGrid(const Pose2& pose) const {
    return left_->LowerBound(pose.position());
  }
  [[nodiscard]] double Left(const Pose2& pose) const;
  [[nodiscard]] std::uint64_t NodeKey(const Node& node) const;
  void Expand(int index, const Node& node, int expansions);
  void Push(const Node& node, double estimate);

  Pose2 target_;
  std::shared_ptr<const GridDistance> left_;
  std::vector<Node> nodes_;
  std::priority_queue<Open> open_;
  std::unordered_map<std::uint64_t, double> best_;  // Cost of the cheapest known node in each cell.
  int expansions_ = 0;
  int last_expansion_ = std::numeric_limits<int>::max();
  std::vector<std::vector<Segment>> last_curves_;
};

}  // namespace trackbed
