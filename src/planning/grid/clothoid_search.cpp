#include "src/planning/grid/clothoid_search.h"

#include <algorithm>
#include <cmath>

#include "src/planning/grid/clothoid_costs.h"
#include "src/planning/grid/pose_tree.h"
#include "trackbed/planning/curves/continuous_curvature.h"

// Each state of the search includes the path's curvature. The five values of the curvature, the
// levels, are multiples of 1/(2r); the start of a rolling car may have another curvature. A step is
// an arc of the present curvature, or a clothoid to the next level on either side. Each clothoid
// has the largest sharpness for one of a few speeds. If the curvature may step at cusps, the first
// arc after a cusp may have any level of curvature.
//
// The last curve of a path, which ends at the goal, is a Dubins or Reeds-Shepp word of continuous
// curvature. Successive attempts to reach the goal try the curves for one speed after another. Only
// the first attempt tries the curves for all speeds; without obstacles, no further attempt is
// needed.

namespace trackbed {
namespace {

class ClothoidSearch final : public PoseTree {
 public:
  ClothoidSearch(const SearchSpace& space, const Resolution& resolution, SearchSide side,
                 std::shared_ptr<const GridDistance> left)
      : PoseTree(space, resolution, side, std::move(left)),
        drive_(problem_.clothoids),
        costs_(vehicle_, options_, drive_, radius_),
        speeds_(costs_.Speeds()),
        max_curvature_(std::max(1.0 / radius_, std::abs(drive_.start_curvature))) {
    for (const double speed : speeds_) {
      const double curvature = std::min(max_curvature_, costs_.CurvatureAt(speed));
      curves_.emplace_back(
          CurveLimits{.radius = 1.0 / curvature, .sharpness = costs_.SharpnessAt(speed)});
    }
  }

 private:
  using PoseTree::IsFree;

  /// If the first path was found after n expansions, the search ends n + kMoreExpansions later.
  /// The estimated costs to the goal neglect that the car is slow on clothoids. A search until no
  /// path can be cheaper would take a hundred times as long as the search for the first path.
  static constexpr int kMoreExpansions = 1500;

  /// Index of the level with the largest curvature; the smallest level has the index -kLevels.
  static constexpr int kLevels = 2;

  [[nodiscard]] double LevelCurvature(int level) const { return level * (0.5 / radius_); }

  /// Returns whether the car may turn its wheels at rest before it leaves a node in a direction.
  [[nodiscard]] bool TurnsAtRest(const Node& node, int direction) const {
    if (options_.curvature != CurveCurvature::kCuspSteps) {
      return false;
    }
    if (node.parent < 0) {
      return from_start_ ? drive_.rests_at_start : drive_.rests_at_goal;
    }
    return node.step.direction != direction;
  }

  /// Returns whether the car may drive a step from a node.
  [[nodiscard]] bool MayDrive(const Node& node, const Segment& segment) const {
    return !from_start_ || costs_.BrakesFor(segment, node.length);
  }

  [[nodiscard]] std::vector<Step> Steps(const Node& node) const override {
    std::vector<Step> steps;
    const auto add = [&](const Segment& segment, double end_curvature) {
      if (MayDrive(node, segment)) {
        steps.push_back({segment, end_curvature});
      }
    };
    const auto add_arc = [&](int direction, double curvature) {
      add({.length = resolution_.step, .curvature = curvature, .direction = direction}, curvature);
    };
    for (const int direction : {1, -1}) {
      if (IsReverse({.direction = direction}) && !options_.reverse) {
        continue;
      }
      if (TurnsAtRest(node, direction)) {
        for (int level = -kLevels; level <= kLevels; ++level) {
          add_arc(direction, LevelCurvature(level));
        }
        continue;
      }
      add_arc(direction, node.curvature);
      // A level that differs from the node's curvature only by rounding counts as equal.
      constexpr double kRounding = 1e-9;
      const double level = 2.0 * node.curvature * radius_;
      const int above = static_cast<int>(std::floor(level + kRounding)) + 1;
      const int below = static_cast<int>(std::ceil(level - kRounding)) - 1;
      for (const int next : {std::min(above, kLevels), std::max(below, -kLevels)}) {
        AddClothoids(node, direction, LevelCurvature(next), add);
      }
    }
    return steps;
  }

  /// Calls `add` with the clothoids that lead from a node to the given curvature.
  template <typename Add>
  void AddClothoids(const Node& node, int direction, double curvature, const Add& add) const {
    const double change = curvature - node.curvature;
    const double largest = std::max(std::abs(curvature), std::abs(node.curvature));
    if (std::abs(change) * radius_ < 1e-9) {
      return;
    }
    for (const double speed : speeds_) {
      // Skip speeds that are too fast for the curvature: at a lower speed, the sharpness could be
      // larger.
      if (costs_.CurvatureAt(speed) < largest && speed != speeds_.back()) {
        continue;
      }
      const double sharpness = std::copysign(costs_.SharpnessAt(speed), change);
      add({.length = change / sharpness,
           .curvature = node.curvature,
           .direction = direction,
           .sharpness = sharpness},
          curvature);
    }
  }

  [[nodiscard]] double StepCost(const Segment& before, const Segment& segment) const override {
    return costs_.Of(before, segment, IsReverse(segment));
  }

  [[nodiscard]] Pose2 EndOf(const Pose2& pose, const Segment& segment) const override {
    if (segment.sharpness == 0.0) {
      const double along = segment.direction * segment.length;
      return MoveOnArc(pose, along, segment.curvature * along);
    }
    const trackbed::Path path(pose, {segment});
    return path.At(path.length()).pose;
  }

  [[nodiscard]] bool IsFree(const Pose2& pose, const Segment& segment) const override {
    return segment.sharpness == 0.0 ? clear_.IsFree(pose, segment)
                                    : !clear_.FirstBlocked(trackbed::Path(pose, {segment}));
  }

  [[nodiscard]] std::uint64_t CurvatureBin(const Node& node) const override {
    const auto level = static_cast<int>(std::lround(2.0 * node.curvature * radius_));
    return static_cast<std::uint64_t>(std::clamp(level, -3, 3) + 3);
  }

  /// Returns the candidate curves (words) between two states, as path segments.
  [[nodiscard]] std::vector<std::vector<Segment>> Words(const ContinuousCurves& curves,
                                                        const CurveState& from,
                                                        const CurveState& to) const {
    std::vector<std::vector<Segment>> words;
    const auto add = [&](const std::vector<ShortestCurve>& found) {
      std::transform(found.begin(), found.end(), std::back_inserter(words), ToSegments);
    };
    if (!options_.reverse) {
      add(curves.DubinsWords(from, to));
    } else if (from.curvature == 0.0 && to.curvature == 0.0) {
      add(options_.curvature == CurveCurvature::kCuspSteps ? curves.HybridReedsSheppWords(from, to)
                                                           : curves.ReedsSheppWords(from, to));
    } else {
      // Between states of nonzero curvature, there are many curves with cusps, which need much
      // time.
      add(curves.DubinsWords(from, to));
      for (const ShortestCurve& word : curves.DubinsWords(to, from)) {
        words.push_back(Reversed(ToSegments(word)));
      }
    }
    return words;
  }

  /// Returns whether a car that rolls at the start can slow down for all segments of the path that
  /// ends with a curve from a node.
  [[nodiscard]] bool SlowsDown(int index, const Node& node,
                               const std::vector<Segment>& curve) const {
    if (drive_.start_speed == 0.0) {
      return true;
    }
    double length = from_start_ ? node.length : 0.0;
    std::vector<Segment> path = from_start_ ? std::vector<Segment>{} : StepsTo(index);
    path.insert(path.end(), curve.begin(), curve.end());
    for (const Segment& segment : InSearchOrder(std::move(path))) {
      if (!costs_.BrakesFor(segment, length)) {
        return false;
      }
      length += segment.length;
    }
    return true;
  }

  void TryToEnd(int index, const Node& node) override {
    constexpr std::size_t kMaxAttempts = 4;
    struct Curve {
      std::vector<Segment> segments;
      double cost;
    };
    const auto [from, to] = CurveEnds(node.pose);
    const CurveState start{from, from_start_ ? node.curvature : drive_.start_curvature};
    const CurveState goal{to, from_start_ ? 0.0 : node.curvature};
    const bool all = attempts_++ == 0;
    std::vector<Curve> curves;
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      const double largest = std::max(std::abs(start.curvature), std::abs(goal.curvature));
      constexpr double kRounding = 1e-9;
      if ((!all && i != attempts_ % curves_.size()) ||
          largest * curves_[i].limits().radius > 1.0 + kRounding) {
        continue;
      }
      for (std::vector<Segment>& word : Words(curves_[i], start, goal)) {
        std::vector<Segment> segments = InSearchOrder(std::move(word));
        const double cost = EndCost(node, segments);
        if (cost < best_end_ && SlowsDown(index, node, segments)) {
          curves.push_back({std::move(segments), cost});
        }
      }
    }
    std::stable_sort(curves.begin(), curves.end(),
                     [](const Curve& a, const Curve& b) { return a.cost < b.cost; });
    curves.resize(std::min(curves.size(), kMaxAttempts));
    for (Curve& curve : curves) {
      if (IsFree(node.pose, curve.segments)) {
        EndAfter(expansions() + kMoreExpansions);
        AddEnd(index, curve.cost, std::move(curve.segments));
        return;
      }
    }
  }

  const ClothoidDrive& drive_;
  ClothoidCosts costs_;
  std::vector<double> speeds_;
  double max_curvature_;                  // [1/m]
  std::vector<ContinuousCurves> curves_;  // for each speed
  std::size_t attempts_ = 0;
};

}  // namespace

std::unique_ptr<PoseSearch> MakeClothoidSearch(const SearchSpace& space,
                                               const Resolution& resolution, SearchSide side,
                                               std::shared_ptr<const GridDistance> left) {
  return std::make_unique<ClothoidSearch>(space, resolution, side, std::move(left));
}

}  // namespace trackbed
