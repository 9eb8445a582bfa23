#include "src/path/curve_step.h"

#include <array>
#include <cmath>
#include <utility>

namespace trackbed {
namespace {

/// Returns the change of the heading between two nodes [rad].
double TurnBetween(const CurveNode& from, const CurveNode& to) {
  const double h = to.length;
  return h * (from.curvature + h * (from.sharpness / 3.0 + to.sharpness / 6.0));
}

/// Integrals over a segment of length h. The integrands are three factors times the vector from the
/// segment's point at the distance d to its end. The factors 1, d - d^2/(2 h) and d^2/(2 h) are the
/// effects of the start curvature and of the sharpness at both ends on the curvature at the
/// distance d.
struct Levers {
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  Eigen::Vector3d left = Eigen::Vector3d::Zero();
};

/// Computes the integrals of Levers in the frame of the segment's end, for the mean curvature of
/// the segment.
Levers LeversOf(double h, double turn) {
  const double bend = turn / h;
  Levers levers;
  const double node = std::sqrt(0.6);
  for (const auto& [place, weight] : std::array<std::pair<double, double>, 3>{
           {{-node, 5.0 / 18.0}, {0.0, 4.0 / 9.0}, {node, 5.0 / 18.0}}}) {
    const double d = 0.5 * h * (1.0 + place);
    const double rest = h - d;
    const double angle = bend * rest;
    const Eigen::Vector3d effect(1.0, d - d * d / (2.0 * h), d * d / (2.0 * h));
    // Use the Taylor series of sin(angle)/bend and (cos(angle) - 1)/bend, where `bend` is the mean
    // curvature.
    levers.along += h * weight * rest * (1.0 - angle * angle / 6.0) * effect;
    levers.left -= h * weight * rest * angle * (0.5 - angle * angle / 24.0) * effect;
  }
  return levers;
}

}  // namespace

Segment SegmentBetween(const CurveNode& from, const CurveNode& to) {
  return {.length = to.length,
          .curvature = from.curvature,
          .sharpness = from.sharpness,
          .sharpness_rate = (to.sharpness - from.sharpness) / to.length};
}

CurveNode Follow(const CurveNode& from, const CurveNode& to) {
  const Path path(from.pose, {SegmentBetween(from, to)});
  CurveNode end = to;
  end.pose = path.At(path.length()).pose;
  end.curvature = from.curvature + 0.5 * to.length * (from.sharpness + to.sharpness);
  return end;
}

CurveStep Linearize(const CurveNode& from, const CurveNode& to, double slide, double next_slide) {
  const CurveNode end = Follow(from, to);
  const Vec2 along = Direction(to.pose.yaw);
  const Vec2 left = LeftNormal(along);
  const Vec2 from_along = Direction(from.pose.yaw);
  const Vec2 from_left = LeftNormal(from_along);
  const Vec2 gap = end.pose.position() - to.pose.position();
  const Vec2 chord = end.pose.position() - from.pose.position();
  const double h = to.length;
  const Levers levers = LeversOf(h, TurnBetween(from, to));
  CurveStep step;
  step.length.setZero();
  step.length(kOne) = next_slide - along.dot(gap) - along.dot(from_along) * slide;
  step.length(kOffset) = -along.dot(from_left);
  step.length(kHeading) = left.dot(chord);
  step.length(kCurvature) = levers.left(0);
  step.length(kSharpness) = levers.left(1);
  step.length_control = levers.left(2);
  step.next.setZero();
  step.next(kOffset, kOne) = left.dot(gap) + left.dot(from_along) * slide;
  step.next(kOffset, kOffset) = left.dot(from_left);
  step.next(kOffset, kHeading) = along.dot(chord);
  step.next(kOffset, kCurvature) = levers.along(0);
  step.next(kOffset, kSharpness) = levers.along(1);
  step.control(kOffset) = levers.along(2);
  const double bend = from.curvature + h * (2.0 / 3.0 * from.sharpness + to.sharpness / 3.0);
  step.next.row(kHeading) = bend * step.length;
  step.next(kHeading, kOne) += end.pose.yaw - to.pose.yaw;
  step.next(kHeading, kHeading) += 1.0;
  step.next(kHeading, kCurvature) += h;
  step.next(kHeading, kSharpness) += h * h / 3.0;
  step.control(kHeading) = h * h / 6.0 + bend * step.length_control;
  const double rate = 0.5 * (from.sharpness + to.sharpness);
  step.next.row(kCurvature) = rate * step.length;
  step.next(kCurvature, kOne) += end.curvature - to.curvature;
  step.next(kCurvature, kCurvature) += 1.0;
  step.next(kCurvature, kSharpness) += 0.5 * h;
  step.control(kCurvature) = 0.5 * h + rate * step.length_control;
  return step;
}

void AddSquare(StateMatrix& cost, const StateRow& row, double weight) {
  cost += weight * row.transpose() * row;
}

StateMatrix Eliminate(CurveStep& step, const StateMatrix& next_cost, const CurveNode& from,
                      const CurveNode& to, double smoothing) {
  // The extended state at the next node is motion * state + control * u, where u is the change of
  // the next node's sharpness.
  StateMatrix motion = StateMatrix::Identity();
  motion.topRows<3>() = step.next;
  motion.row(kSharpness).setZero();
  StateVector control = StateVector::Zero();
  control.head<3>() = step.control;
  control(kSharpness) = 1.0;
  const StateMatrix weighted = next_cost * motion;
  StateMatrix cost = motion.transpose() * weighted;
  StateRow mixed = control.transpose() * weighted;
  double own = control.dot(next_cost * control);
  // The squared sharpness error is integrated over the segment of length h. For a linear function
  // with the end values a and b + u, this integral is h/3 (a^2 + a (b + u) + (b + u)^2).
  StateRow a = StateRow::Zero();
  a(kSharpness) = 1.0;
  a(kOne) = from.sharpness;
  a(kMean) = -1.0;
  StateRow b = StateRow::Zero();
  b(kOne) = to.sharpness;
  b(kMean) = -1.0;
  const double weight = smoothing * to.length / 3.0;
  cost += weight * (2.0 * a.transpose() * a + a.transpose() * b + b.transpose() * a +
                    2.0 * b.transpose() * b);
  mixed += weight * (a + 2.0 * b);
  own += 2.0 * weight;
  step.gain = -mixed / own;
  cost += mixed.transpose() * step.gain;
  return 0.5 * (cost + cost.transpose());
}

}  // namespace trackbed
