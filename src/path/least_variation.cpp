#include "src/path/least_variation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "src/path/curve_step.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

// Fits a minimum variation curve by Newton's method, which linearizes the curve at its nodes in
// each iteration. In an iteration, a node moves by n across the curve. A node also moves by a known
// distance along the curve, to the curve point nearest to its given point. The linearized problem
// is a linear-quadratic control problem with the state (n, heading, curvature, sharpness) and the
// sharpness of the next node as its control. The Riccati recursion eliminates the controls from the
// last node to the first. The state is extended by constants: the multipliers of the end
// conditions, the mean sharpness c, and the number 1 for the affine terms. Newton's method moves
// the nodes independently, and the gaps between segments close as it converges (multiple shooting).
// After convergence, the segments are joined.
//
// The bound of the curvature is a quadratic penalty at the nodes that exceed it. The nodes that
// exceed the bound are found anew in each iteration (a semismooth Newton method).
//
// All lengths are divided by the smoothing length, which makes the weights independent of the
// units.

namespace trackbed {
namespace {

/// The movement of a node and the change of the length of the segment before the node.
struct Change {
  Eigen::Matrix<double, kStates, 1> state;
  double length = 0.0;
};

/// Returns an upper bound of the heading changes within a segment [rad].
double MaxTurn(const CurveNode& from, const CurveNode& to) {
  const double h = to.length;
  return h * (std::abs(from.curvature) +
              h * (std::abs(from.sharpness) / 3.0 + std::abs(to.sharpness) / 6.0));
}

// Largest heading change of a segment [rad].
constexpr double kMaxTurn = 2.0 * kPi;

// Smallest factor by which an iteration may shorten a segment.
constexpr double kMinShortening = 0.2;

class Newton {
 public:
  Newton(std::vector<CurveNode> nodes, bool closed, const EndHeadings& headings,
         double max_curvature)
      : nodes_(std::move(nodes)),
        closed_(closed),
        headings_(headings),
        max_curvature_(max_curvature) {
    for (const CurveNode& node : nodes_) {
      shortest_.push_back(kMinShortening * node.length);
    }
  }

  /// Moves the curve's nodes by one Newton step. Returns the largest movement of a node, or
  /// infinity if the curve degenerates.
  double Iterate();
  /// Joins the nodes by moving each to the end of the segment before it.
  void Join();
  /// Returns the largest violation of an end condition by the joined curve.
  [[nodiscard]] double EndError() const;
  [[nodiscard]] const std::vector<CurveNode>& nodes() const { return nodes_; }

 private:
  void Slide();
  double Move(StateVector state);
  void AddPoint(StateMatrix& cost, const CurveNode& node) const;
  void AddBound(StateMatrix& cost, std::size_t node) const;
  StateVector Start(const StateMatrix& cost) const;

  std::vector<CurveNode> nodes_;
  bool closed_;
  EndHeadings headings_;
  double max_curvature_;          // Bound of the curvature, in units of 1/(smoothing length).
  double mean_ = 0.0;             // The constant c of the cost (mean sharpness).
  std::vector<double> shortest_;  // Smallest length of the segment before each node.
  std::vector<double> slides_;    // Distance that each node moves along the curve.
  std::vector<CurveStep> steps_;
  std::vector<Change> changes_;
};

/// Computes by how far each node slides along the curve. A node with a given point slides to the
/// point's foot on the curve. The slides of nodes without a given point are interpolated linearly
/// between nodes with a given point.
void Newton::Slide() {
  const std::size_t count = nodes_.size();
  slides_.assign(count, 0.0);
  std::size_t before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_end = closed_ && i + 1 == count;
    if (!is_end && !nodes_[i].point) {
      continue;
    }
    slides_[i] =
        is_end ? slides_[0]
               : Direction(nodes_[i].pose.yaw).dot(*nodes_[i].point - nodes_[i].pose.position());
    double length = 0.0;
    for (std::size_t k = before + 1; k <= i; ++k) {
      length += nodes_[k].length;
    }
    double at = 0.0;
    for (std::size_t k = before + 1; k < i; ++k) {
      at += nodes_[k].length;
      slides_[k] = std::lerp(slides_[before], slides_[i], at / length);
    }
    before = i;
  }
  // Limit the slides so that each segment keeps its smallest length, because two given points may
  // be closer together along the curve.
  const double last = slides_.back();
  for (std::size_t i = 1; i < count; ++i) {
    slides_[i] = std::max(slides_[i], slides_[i - 1] + shortest_[i] - nodes_[i].length);
  }
  slides_.back() = last;
  for (std::size_t i = count - 1; i > 0; --i) {
    slides_[i - 1] = std::min(slides_[i - 1], slides_[i] + nodes_[i].length - shortest_[i]);
  }
  if (closed_) {
    slides_.back() = slides_.front();
  }
}

double OffsetOf(const CurveNode& node) {
  return LeftNormal(Direction(node.pose.yaw)).dot(*node.point - node.pose.position());
}

void Newton::AddPoint(StateMatrix& cost, const CurveNode& node) const {
  if (node.point) {
    StateRow row = StateRow::Zero();
    row(kOffset) = 1.0;
    row(kOne) = -OffsetOf(node);
    AddSquare(cost, row, node.weight);
  }
}

/// Adds to the cost the penalty of a node whose curvature exceeds its bound.
void Newton::AddBound(StateMatrix& cost, std::size_t node) const {
  constexpr double kPenalty = 1e5;
  const double own = nodes_[node].curvature;
  if (!(std::abs(own) > max_curvature_)) {
    return;
  }
  const double before = node > 0 ? nodes_[node].length : 0.0;
  const double after = node + 1 < nodes_.size() ? nodes_[node + 1].length : 0.0;
  StateRow row = StateRow::Zero();
  row(kCurvature) = 1.0;
  row(kOne) = own - std::copysign(max_curvature_, own);
  AddSquare(cost, row, 0.5 * kPenalty * (before + after));
}

/// Returns the state at the first node that minimizes the cost and satisfies the end conditions.
StateVector Newton::Start(const StateMatrix& cost) const {
  StateVector state = StateVector::Zero();
  state(kOne) = 1.0;
  std::vector<int> free{kHeading, kCurvature, kSharpness, kMean, kMultiplier};
  if (closed_) {
    free = {kOffset, kHeading, kCurvature, kSharpness, kMean};
    for (int i = 0; i < kStates; ++i) {
      free.push_back(kMultiplier + i);
    }
  } else {
    state(kOffset) = OffsetOf(nodes_.front());
    if (headings_.begin) {
      state(kHeading) = AngleDifference(*headings_.begin, nodes_.front().pose.yaw);
      free.erase(free.begin());
    }
    if (headings_.end) {
      free.push_back(kMultiplier + kHeading);
    }
  }
  const Eigen::MatrixXd system = cost(free, free);
  const Eigen::VectorXd right = -(cost * state)(free);
  Eigen::FullPivLU<Eigen::MatrixXd> solver(system);
  solver.setThreshold(0.0);
  const Eigen::VectorXd found = solver.solve(right);
  for (std::size_t i = 0; i < free.size(); ++i) {
    state(free[i]) = found(static_cast<Eigen::Index>(i));
  }
  return state;
}

double Newton::Iterate() {
  Slide();
  const std::size_t count = nodes_.size();
  StateMatrix cost = StateMatrix::Zero();
  if (closed_) {
    for (int i = 0; i < kStates; ++i) {
      cost(i, kMultiplier + i) = cost(kMultiplier + i, i) = 1.0;
    }
  } else {
    cost(kOffset, kMultiplier) = cost(kMultiplier, kOffset) = 1.0;
    cost(kOne, kMultiplier) = cost(kMultiplier, kOne) = -OffsetOf(nodes_.back());
    if (headings_.end) {
      constexpr int kTurn = kMultiplier + kHeading;
      cost(kHeading, kTurn) = cost(kTurn, kHeading) = 1.0;
      cost(kOne, kTurn) = cost(kTurn, kOne) =
          -AngleDifference(*headings_.end, nodes_.back().pose.yaw);
    }
  }
  AddBound(cost, count - 1);
  // Add a small cost of changes of the mean sharpness c, so that c stays unchanged if the points do
  // not determine it, as with three points.
  double length = 0.0;
  for (std::size_t i = 1; i < count; ++i) {
    length += nodes_[i].length;
  }
  StateRow change = StateRow::Zero();
  change(kMean) = 1.0;
  change(kOne) = -mean_;
  AddSquare(cost, change, 1e-9 * std::min(length, std::pow(length, 7)));
  steps_.resize(count);
  for (std::size_t i = count - 1; i > 0; --i) {
    // Use a smoothing length of at least a sixteenth of the segment's length, because a shorter one
    // would only cause rounding errors.
    const double smoothing = std::pow(std::max(1.0, nodes_[i].length / 16.0), 6);
    steps_[i] = Linearize(nodes_[i - 1], nodes_[i], slides_[i - 1], slides_[i]);
    cost = Eliminate(steps_[i], cost, nodes_[i - 1], nodes_[i], smoothing);
    if (i > 1 || closed_) {
      AddPoint(cost, nodes_[i - 1]);
    }
    AddBound(cost, i - 1);
  }
  if (closed_) {
    for (int i = 0; i < kStates; ++i) {
      cost(i, kMultiplier + i) -= 1.0;
      cost(kMultiplier + i, i) -= 1.0;
    }
  }
  return Move(Start(cost));
}

double Newton::Move(StateVector state) {
  // Largest movement of a node in one iteration, divided by the smoothing length, and largest
  // change of its heading [rad].
  constexpr double kMaxMove = 0.5;
  const std::size_t count = nodes_.size();
  const double mean = state(kMean);
  double largest = 0.0;
  double share = 1.0;
  changes_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    Change& change = changes_[i];
    change.length = 0.0;
    if (i > 0) {
      const CurveStep& step = steps_[i];
      const double control = step.gain.dot(state);
      change.length = step.length.dot(state) + step.length_control * control;
      const Eigen::Vector3d next = step.next * state + step.control * control;
      state.head<3>() = next;
      state(kSharpness) = control;
      share = std::min(share, 0.5 * nodes_[i].length / std::max(-change.length, 1e-300));
    }
    change.state = state.head<kStates>();
    largest =
        std::max({largest, std::hypot(slides_[i], state(kOffset)), std::abs(state(kHeading))});
    if (!change.state.allFinite() || !std::isfinite(change.length)) {
      return std::numeric_limits<double>::infinity();
    }
  }
  share = std::min(share, kMaxMove / std::max(largest, kMaxMove));
  mean_ += share * (mean - mean_);
  for (std::size_t i = 0; i < count; ++i) {
    CurveNode& node = nodes_[i];
    const Change& change = changes_[i];
    const Vec2 along = Direction(node.pose.yaw);
    const Vec2 move = share * (slides_[i] * along + change.state(kOffset) * LeftNormal(along));
    node.pose = {node.pose.x + move.x(), node.pose.y + move.y(),
                 node.pose.yaw + share * change.state(kHeading)};
    node.curvature += share * change.state(kCurvature);
    node.sharpness += share * change.state(kSharpness);
    node.length += share * change.length;
    if (i > 0 && MaxTurn(nodes_[i - 1], node) > kMaxTurn) {
      return std::numeric_limits<double>::infinity();
    }
  }
  return largest;
}

double Newton::EndError() const {
  const CurveNode& last = nodes_.back();
  if (!closed_) {
    const auto turned = [](const std::optional<double>& heading, const CurveNode& node) {
      return heading ? std::abs(AngleDifference(*heading, node.pose.yaw)) : 0.0;
    };
    return std::max({(*last.point - last.pose.position()).norm(),
                     (*nodes_.front().point - nodes_.front().pose.position()).norm(),
                     turned(headings_.begin, nodes_.front()), turned(headings_.end, last)});
  }
  const CurveNode& first = nodes_.front();
  return std::max((last.pose.position() - first.pose.position()).norm(),
                  std::abs(AngleDifference(last.pose.yaw, first.pose.yaw)));
}

void Newton::Join() {
  for (std::size_t i = 1; i < nodes_.size(); ++i) {
    nodes_[i] = Follow(nodes_[i - 1], nodes_[i]);
  }
}

/// Multiplies all lengths of the curve by a factor.
void Scale(std::vector<CurveNode>& nodes, double factor) {
  for (CurveNode& node : nodes) {
    node.pose.x *= factor;
    node.pose.y *= factor;
    node.curvature /= factor;
    node.sharpness /= factor * factor;
    node.length *= factor;
    node.weight *= factor;
    if (node.point) {
      *node.point *= factor;
    }
  }
}

}  // namespace

std::optional<std::vector<CurveNode>> LeastVariationCurve(std::vector<CurveNode> nodes,
                                                          double smoothing_length, bool closed,
                                                          const EndHeadings& headings,
                                                          double max_curvature) {
  constexpr int kMaxIterations = 30;
  // Number of iterations after which the search ends if nodes still move by kFar smoothing lengths.
  constexpr int kFarIterations = 10;
  constexpr double kFar = 0.1;
  double length = 0.0;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    length += nodes[i].length;
  }
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if (!(nodes[i].length > 0.0 && MaxTurn(nodes[i - 1], nodes[i]) <= kMaxTurn)) {
      return std::nullopt;
    }
  }
  Scale(nodes, 1.0 / smoothing_length);
  Newton newton(std::move(nodes), closed, headings, max_curvature * smoothing_length);
  // Movement of a node below which rounding errors dominate.
  const double rounding = 1e-14 * length / smoothing_length;
  double before = std::numeric_limits<double>::infinity();
  bool is_joined = false;
  for (int i = 0; i < kMaxIterations; ++i) {
    const double moved = newton.Iterate();
    if (!std::isfinite(moved) || (i >= kFarIterations && moved > kFar)) {
      return std::nullopt;
    }
    const bool is_still = moved <= rounding || (moved < 1e-7 && moved > 0.5 * before);
    const bool was_joined = is_joined;
    is_joined = is_joined || moved < 1e-4;
    if (is_joined) {
      newton.Join();
    }
    if (was_joined && (is_still || i + 1 == kMaxIterations)) {
      break;
    }
    before = moved;
  }
  constexpr double kMaxEndError = 1e-10;  // [m]
  if (!is_joined ||
      newton.EndError() > std::max(1000.0 * rounding, kMaxEndError / smoothing_length)) {
    return std::nullopt;
  }
  std::vector<CurveNode> found = newton.nodes();
  Scale(found, smoothing_length);
  return found;
}

std::vector<Segment> SegmentsBetween(const std::vector<CurveNode>& nodes) {
  std::vector<Segment> segments;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    segments.push_back(SegmentBetween(nodes[i - 1], nodes[i]));
  }
  return segments;
}

}  // namespace trackbed
