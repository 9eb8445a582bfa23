#include "src/planning/grid/arc_search.h"

#include <algorithm>
#include <cmath>

#include "src/planning/grid/pose_tree.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"

// The steps of hybrid A* are arcs of curvature 0, +-1/(2r) and +-1/r, with the turning radius r.
// The curves to the goal are the shortest curves of arcs and straights, with gentler arcs in place
// of short ones.

namespace trackbed {
namespace {

class ArcSearch final : public PoseTree {
 public:
  using PoseTree::PoseTree;

 private:
  using PoseTree::IsFree;

  [[nodiscard]] std::vector<Step> Steps(const Node& node) const override {
    std::vector<Step> steps;
    for (const int direction : {1, -1}) {
      for (const double bend : {0.0, 0.5, -0.5, 1.0, -1.0}) {
        const Segment step{
            .length = resolution_.step, .curvature = bend / radius_, .direction = direction};
        if (IsReverse(step) && (!options_.reverse || MustGoForwards(node))) {
          break;
        }
        steps.push_back({step});
      }
    }
    return steps;
  }

  [[nodiscard]] double StepCost(const Segment& before, const Segment& segment) const override {
    double cost = segment.length * (IsReverse(segment) ? options_.reverse_cost : 1.0);
    if (before.length > 0.0) {
      cost += before.direction != segment.direction ? options_.switch_cost : 0.0;
      cost += options_.steering_cost * radius_ * std::abs(segment.curvature - before.curvature);
    }
    return cost;
  }

  [[nodiscard]] Pose2 EndOf(const Pose2& pose, const Segment& segment) const override {
    const double along = segment.direction * segment.length;
    return MoveOnArc(pose, along, segment.curvature * along);
  }

  [[nodiscard]] bool IsFree(const Pose2& pose, const Segment& segment) const override {
    return clear_.IsFree(pose, segment);
  }

  [[nodiscard]] std::uint64_t CurvatureBin(const Node& /*node*/) const override { return 0; }

  /// Tries to reach the goal by the cheapest collision-free curve among the few cheapest curves.
  void TryToEnd(int index, const Node& node) override {
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
        AddEnd(index, curve.cost, std::move(curve.segments));
        return;
      }
    }
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

  /// Returns the pieces of the last curve of a path. Gentler arcs replace short arcs if the curve
  /// then costs no more, or if the car would have to stop on the curve with short arcs.
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
};

}  // namespace

std::unique_ptr<PoseSearch> MakeArcSearch(const SearchSpace& space, const Resolution& resolution,
                                          SearchSide side,
                                          std::shared_ptr<const GridDistance> left) {
  return std::make_unique<ArcSearch>(space, resolution, side, std::move(left));
}

}  // namespace trackbed
