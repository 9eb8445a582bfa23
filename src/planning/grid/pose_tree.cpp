#include "src/planning/grid/pose_tree.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"

// Hybrid A* (Dolgov et al. 2008) searches over poses that a car can reach, forwards and in reverse.
// The heuristic is the larger of the Reeds-Shepp (or Dubins) length and the grid distance.
// Dijkstra's algorithm computes the grid distance around the obstacles. To expand a node, the
// search drives arcs or clothoids forwards and in reverse (arc_search.cpp, clothoid_search.cpp).
// The search keeps only the cheapest node per cell of position, heading, direction and, with
// clothoids, curvature. The nearer a node is to the goal, the more often the search tries a
// collision-free curve to the goal. The search ends when the cheapest open node is at the goal,
// reached by a collision-free curve. A search from the goal expands nodes along the path driven
// backwards in time, from the goal to the start.

namespace trackbed {
namespace {

/// Returns whether a path may drive both segments as one: as one arc, or as one clothoid.
bool Continues(const Segment& before, const Segment& segment) {
  if (before.direction != segment.direction || before.sharpness != segment.sharpness) {
    return false;
  }
  // The curvature at the end of a clothoid is rounded.
  constexpr double kRounding = 1e-12;
  const double end = before.CurvatureAt(before.length);
  return std::abs(end - segment.curvature) <=
         (before.sharpness == 0.0 ? 0.0 : kRounding * std::abs(end));
}

}  // namespace

std::vector<Segment> Reversed(std::vector<Segment> segments) {
  std::reverse(segments.begin(), segments.end());
  for (Segment& segment : segments) {
    if (segment.sharpness != 0.0) {
      segment.curvature = segment.CurvatureAt(segment.length);
      segment.sharpness = -segment.sharpness;
    }
    segment.direction = -segment.direction;
  }
  return segments;
}

PoseTree::PoseTree(const SearchSpace& space, const Resolution& resolution, SearchSide side,
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
  nodes_.push_back({.pose = from_start_ ? problem_.start : problem_.goal,
                    .curvature = from_start_ ? problem_.clothoids.start_curvature : 0.0});
  open_.push({options_.weight * Left(nodes_.front().pose), 0});
}

void PoseTree::Advance() {
  while (!ended()) {
    const int index = open_.top().node;
    const Node node = nodes_[static_cast<std::size_t>(index)];
    open_.pop();
    if (node.parent < 0 || best_.at(NodeKey(node)) >= node.cost) {
      Expand(index, node, ++expansions_);
      return;
    }
    // Skip the node: the search has since found a cheaper path to this cell.
  }
}

std::vector<Segment> PoseTree::StepsTo(int index) const {
  std::vector<Segment> steps;
  for (int i = index; nodes_[static_cast<std::size_t>(i)].parent >= 0;) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    steps.push_back(node.step);
    i = node.parent;
  }
  std::reverse(steps.begin(), steps.end());
  return steps;
}

std::vector<Segment> PoseTree::Path() const {
  // Among the nodes with a curve to the target, the last node has the cheapest path.
  const auto end = std::find_if(nodes_.rbegin(), nodes_.rend(),
                                [](const Node& node) { return node.last_curve >= 0; });
  std::vector<Segment> path;
  if (end == nodes_.rend()) {
    return path;
  }
  std::vector<Segment> steps = StepsTo(end->parent);
  const auto& last = last_curves_[static_cast<std::size_t>(end->last_curve)];
  steps.insert(steps.end(), last.begin(), last.end());
  for (const Segment& step : InSearchOrder(std::move(steps))) {
    if (!path.empty() && Continues(path.back(), step)) {
      path.back().length += step.length;
    } else {
      path.push_back(step);
    }
  }
  return path;
}

double PoseTree::Left(const Pose2& pose) const {
  const auto [from, to] = CurveEnds(pose);
  const double curve =
      options_.reverse ? ReedsSheppLength(from, to, radius_) : Dubins(from, to, radius_).length;
  return std::max(LeftOnGrid(pose), curve);
}

/// Returns the key of the cell of position, heading, direction of motion and curvature that
/// contains a node.
std::uint64_t PoseTree::NodeKey(const Node& node) const {
  // Keys of bins are unique within 2^22 bins of the start.
  const Vec2 local = ToLocal(problem_.start, node.pose.position()) / resolution_.cell;
  const auto column = static_cast<std::uint64_t>(std::llround(local.x()));
  const auto row = static_cast<std::uint64_t>(std::llround(local.y()));
  const double turn = WrapAngle(node.pose.yaw - problem_.start.yaw) / (2.0 * kPi);
  const std::int64_t heading = std::llround(turn * resolution_.headings) + resolution_.headings;
  const auto headings = static_cast<std::uint64_t>(resolution_.headings);
  const std::uint64_t bin =
      ((row << 26) + column) * headings + static_cast<std::uint64_t>(heading) % headings;
  return (bin * 2 + (node.step.direction > 0 ? 1 : 0)) * 8 + CurvatureBin(node);
}

bool PoseTree::BeginsWell(const Node& node, const std::vector<Segment>& curve) const {
  if (from_start_) {
    return !MustGoForwards(node) || curve.empty() || !IsReverse(curve.front());
  }
  return !problem_.rolls || !IsReverse(curve.empty() ? node.step : curve.back());
}

void PoseTree::Expand(int index, const Node& node, int expansions) {
  // Try a curve to the goal more often near the goal: if n turning radii remain to the goal, try
  // at every (n + 1)-th expansion.
  const double left = Left(node.pose);
  if (expansions % (1 + static_cast<int>(left / radius_)) == 0 || expansions == 1) {
    TryToEnd(index, node);
  }
  for (const auto& [segment, end_curvature] : Steps(node)) {
    Node child{.pose = EndOf(node.pose, segment),
               .curvature = end_curvature,
               .cost = node.cost + StepCost(node.step, segment),
               .length = node.length + segment.length,
               .parent = index,
               .step = segment};
    if (!std::isfinite(LeftOnGrid(child.pose))) {
      continue;
    }
    const auto [best, is_new] = best_.try_emplace(NodeKey(child), child.cost);
    if ((!is_new && best->second <= child.cost) || !IsFree(node.pose, segment)) {
      if (is_new) {
        best_.erase(best);
      }
      continue;
    }
    best->second = child.cost;
    Push(child, child.cost + options_.weight * Left(child.pose));
  }
}

void PoseTree::Push(const Node& node, double estimate) {
  open_.push({estimate, static_cast<int>(nodes_.size())});
  nodes_.push_back(node);
}

std::vector<Segment> PoseTree::InSearchOrder(std::vector<Segment> segments) const {
  return from_start_ ? segments : Reversed(std::move(segments));
}

void PoseTree::AddEnd(int index, double cost, std::vector<Segment> curve) {
  best_end_ = cost;
  Push({.pose = target_,
        .cost = cost,
        .parent = index,
        .step = {},
        .last_curve = static_cast<int>(last_curves_.size())},
       cost);
  last_curves_.push_back(std::move(curve));
}

double PoseTree::EndCost(const Node& node, const std::vector<Segment>& curve) const {
  double cost = node.cost;
  const Segment* before = &node.step;
  for (const Segment& segment : curve) {
    cost += StepCost(*before, segment);
    before = &segment;
  }
  return cost;
}

bool PoseTree::IsFree(Pose2 pose, const std::vector<Segment>& segments) const {
  for (const Segment& segment : segments) {
    if (!IsFree(pose, segment)) {
      return false;
    }
    pose = EndOf(pose, segment);
  }
  return true;
}

}  // namespace trackbed
