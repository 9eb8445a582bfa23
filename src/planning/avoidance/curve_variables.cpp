#include "src/planning/avoidance/curve_variables.h"

#include <vector>

namespace trackbed::avoidance {

EndConditions::EndConditions(const CurveProblem& problem)
    : scale_((problem.end.pose.position() - problem.start.pose.position()).norm()),
      start_curvature_(problem.mirror * problem.start.curvature),
      end_curvature_(problem.mirror * problem.end.curvature),
      end_(problem.Frame().In(problem.end.pose.position())),
      forward_(Direction(problem.Frame().In(problem.end.pose.yaw))) {}

Points EndConditions::ToPoints(Variables x) const {
  constexpr double kOffset = static_cast<double>(kDegree) / (kDegree - 1.0);
  const double a = scale_ * x[kStartFirst];
  const double b = scale_ * x[kStartSecond];
  const double c = scale_ * x[kEndSecond];
  const double d = scale_ * x[kEndFirst];
  const Vec2 last = end_ - d * forward_;
  return {Vec2{0.0, 0.0},
          Vec2{a, 0.0},
          Vec2{a + b, kOffset * start_curvature_ * a * a},
          scale_ * Vec2{x[kX3], x[kY3]},
          scale_ * Vec2{x[kX4], x[kY4]},
          last - c * forward_ + kOffset * end_curvature_ * d * d * LeftNormal(forward_),
          last,
          end_};
}

std::array<double, kVariables> EndConditions::ToVariables(const Points& p) const {
  return {p[1].x() / scale_,
          (p[2] - p[1]).x() / scale_,
          p[3].x() / scale_,
          p[3].y() / scale_,
          p[4].x() / scale_,
          p[4].y() / scale_,
          (p[6] - p[5]).dot(forward_) / scale_,
          (p[7] - p[6]).dot(forward_) / scale_};
}

BasisSamples::BasisSamples() {
  for (std::size_t i = 0; i <= kDegree; ++i) {
    std::vector<Vec2> unit(kDegree + 1, Vec2::Zero());
    unit[i].x() = 1.0;
    const BezierCurve curve(unit);
    for (Eigen::Index k = 0; k < kSamples; ++k) {
      const double u = static_cast<double>(k) / (kSamples - 1);
      for (std::size_t order = 0; order < of_order.size(); ++order) {
        of_order[order](k, static_cast<Eigen::Index>(i)) = curve.Derivative(u, order).x();
      }
    }
  }
}

const BasisSamples& BernsteinBasis() {
  static const BasisSamples basis;
  return basis;
}

BezierCurve InWorld(const CurveProblem& problem, const Points& points) {
  std::vector<Vec2> control;
  for (const Vec2& point : points) {
    control.push_back(problem.Frame().Out(point));
  }
  return BezierCurve(control);
}

}  // namespace trackbed::avoidance
