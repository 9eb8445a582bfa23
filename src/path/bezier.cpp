#include "trackbed/path/bezier.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Evaluates a Bézier curve at u: the Bernstein sum in Horner's form.
Vec2 Evaluate(const std::vector<Vec2>& points, double u) {
  if (points.empty()) {
    return Vec2::Zero();
  }
  const std::size_t n = points.size() - 1;
  if (n == 0) {
    return points.front();
  }
  const double rest = 1.0 - u;
  double power = 1.0;
  double binomial = 1.0;
  Vec2 sum = points.front() * rest;
  for (std::size_t i = 1; i < n; ++i) {
    power *= u;
    binomial *= static_cast<double>(n - i + 1) / static_cast<double>(i);
    sum = (sum + power * binomial * points[i]) * rest;
  }
  return sum + power * u * points.back();
}

/// Returns the control points of the Bézier curve's derivative.
std::vector<Vec2> Hodograph(const std::vector<Vec2>& points) {
  std::vector<Vec2> out;
  const double degree = static_cast<double>(points.size()) - 1.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    out.emplace_back(degree * (points[i] - points[i - 1]));
  }
  return out;
}

}  // namespace

double CurvatureFromDerivatives(const Vec2& first, const Vec2& second) {
  const double speed = first.norm();
  return Cross(first, second) / (speed * speed * speed);
}

double SharpnessFromDerivatives(const Vec2& first, const Vec2& second, const Vec2& third) {
  const double square = first.squaredNorm();
  const double by_parameter =
      (Cross(first, third) - 3.0 * Cross(first, second) * first.dot(second) / square) /
      (square * std::sqrt(square));
  return by_parameter / std::sqrt(square);
}

BezierCurve::BezierCurve(std::vector<Vec2> control_points) {
  TRACKBED_CHECK(control_points.size() >= 2, "{} control points", control_points.size());
  for (const Vec2& point : control_points) {
    TRACKBED_CHECK(point.allFinite(), "control point ({}, {})", point.x(), point.y());
  }
  polygons_[0] = std::move(control_points);
  for (std::size_t i = 1; i < polygons_.size(); ++i) {
    polygons_[i] = Hodograph(polygons_[i - 1]);
  }
}

Vec2 BezierCurve::Derivative(double u, std::size_t order) const {
  return Evaluate(polygons_.at(order), u);
}

double BezierCurve::Curvature(double u) const {
  return CurvatureFromDerivatives(Derivative(u, 1), Derivative(u, 2));
}

double BezierCurve::Sharpness(double u) const {
  return SharpnessFromDerivatives(Derivative(u, 1), Derivative(u, 2), Derivative(u, 3));
}

double BezierCurve::Length(double from, double to) const {
  // Compute the arc length of the Bézier curve as the sum of integrals over sixteenths of the
  // parameter range. Within each sixteenth, the parameter speed |P'| is close to a polynomial, for
  // which Gauss's rule is accurate.
  using Quadrature = boost::math::quadrature::gauss<double, 10>;
  const double pieces = std::max(1.0, std::ceil(16.0 * std::abs(to - from)));
  double length = 0.0;
  for (double i = 0.0; i < pieces; i += 1.0) {
    length += Quadrature::integrate([&](double u) { return Derivative(u, 1).norm(); },
                                    std::lerp(from, to, i / pieces),
                                    std::lerp(from, to, (i + 1.0) / pieces));
  }
  return length;
}

std::vector<CurvePoint> BezierCurve::Points(double spacing, double start_yaw) const {
  constexpr double kMaxPoints = 1e6;
  TRACKBED_CHECK(spacing > 0.0, "spacing {}", spacing);
  TRACKBED_REQUIRE(Length() / spacing <= kMaxPoints,
                   "BezierCurve::Points: {} m every {} m; must be at most {} points", Length(),
                   spacing, kMaxPoints);
  // Upper bound of the parameter speed |P'|: the largest norm of the control points of the
  // derivative P'.
  double fastest = 0.0;
  for (const Vec2& velocity : polygons_[1]) {
    fastest = std::max(fastest, velocity.norm());
  }
  const double intervals = std::max(1.0, std::ceil(fastest / spacing));
  std::vector<CurvePoint> points;
  points.reserve(static_cast<std::size_t>(intervals) + 1);
  CurvePoint last{0.0, start_yaw, 0.0};
  double last_u = 0.0;
  for (double i = 0.0; i <= intervals; i += 1.0) {
    const double u = i / intervals;
    const Vec2 velocity = Derivative(u, 1);
    TRACKBED_CHECK(velocity.squaredNorm() > 0.0, "the curve has no direction at u = {}", u);
    const double yaw = std::atan2(velocity.y(), velocity.x());
    last = {i == 0.0 ? 0.0 : last.s + Length(last_u, u), last.yaw + AngleDifference(yaw, last.yaw),
            Curvature(u)};
    last_u = u;
    points.push_back(last);
  }
  return points;
}

}  // namespace trackbed
