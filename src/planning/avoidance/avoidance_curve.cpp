#include "src/planning/avoidance/avoidance_curve.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "src/planning/avoidance/curve_variables.h"
#include "trackbed/core/error.h"
#include "trackbed/vehicle/steering_reach.h"
#include "trackbed/world/world.h"

// Fit places the control points P_3 and P_4 of a degree-7 Bezier curve by least squares along a
// polyline. The end conditions fix the directions and the curvature at both ends. Check measures
// the clearance, the steering and the lateral acceleration of a finished curve every 5 cm.

namespace trackbed::avoidance {
namespace {

/// Distance between the points at which a finished curve is checked [m].
constexpr double kCheckSpacing = 0.05;

/// Returns evenly spaced points along a polyline, including both ends.
std::vector<Vec2> Evenly(const std::vector<Vec2>& polyline, std::size_t count) {
  std::vector<double> along{0.0};
  for (std::size_t i = 1; i < polyline.size(); ++i) {
    along.push_back(along.back() + (polyline[i] - polyline[i - 1]).norm());
  }
  std::vector<Vec2> points;
  std::size_t i = 1;
  for (std::size_t k = 0; k < count; ++k) {
    const double s = along.back() * static_cast<double>(k) / static_cast<double>(count - 1);
    while (i + 1 < along.size() && along[i] < s) {
      ++i;
    }
    const double piece = along[i] - along[i - 1];
    const double share = piece > 0.0 ? std::clamp((s - along[i - 1]) / piece, 0.0, 1.0) : 0.0;
    points.emplace_back(polyline[i - 1] + share * (polyline[i] - polyline[i - 1]));
  }
  return points;
}

double PolylineLength(const std::vector<Vec2>& polyline) {
  double length = 0.0;
  for (std::size_t i = 1; i < polyline.size(); ++i) {
    length += (polyline[i] - polyline[i - 1]).norm();
  }
  return length;
}

}  // namespace

double CurveProblem::SpeedAt(double distance) const {
  const double square = start_speed * start_speed - 2.0 * deceleration * distance;
  return std::sqrt(std::max(square, speed * speed));
}

bool CurveCheck::Keeps(const CurveProblem& problem) const {
  return clearance >= problem.safe_distance && steering <= SteeringReach(problem.vehicle, 0.0) &&
         steering_rate <= problem.steering_rate &&
         lateral_acceleration <= problem.lateral_acceleration;
}

CurveCheck Check(const CurveProblem& problem, const BezierCurve& curve) {
  const VehicleParams& vehicle = problem.vehicle;
  CurveCheck check;
  check.clearance = std::numeric_limits<double>::infinity();
  const Path path(problem.start.pose,
                  SegmentsThrough(curve.Points(kCheckSpacing, problem.start.pose.yaw)));
  check.length = path.length();
  for (const PathPoint& point : path.Sample(kCheckSpacing)) {
    const double speed = problem.SpeedAt(point.s);
    const double tangent = vehicle.wheelbase * point.curvature;
    const double rate = vehicle.wheelbase * point.sharpness / (1.0 + tangent * tangent) * speed;
    check.steering = std::max(check.steering, std::abs(std::atan(tangent)));
    check.steering_rate = std::max(check.steering_rate, std::abs(rate));
    check.lateral_acceleration =
        std::max(check.lateral_acceleration, std::abs(point.curvature) * speed * speed);
    for (const OrientedBox& obstacle : problem.obstacles) {
      check.clearance =
          std::min(check.clearance, Distance(FootprintAt(vehicle, point.pose), obstacle));
    }
  }
  return check;
}

double CrossingY(const Vec2& a, const Vec2& b) {
  return a.y() + (b.y() - a.y()) * a.x() / (a.x() - b.x());
}

bool GoesThrough(const PassageConstraint& passage, const std::vector<Vec2>& polyline) {
  int crossings = 0;
  for (std::size_t i = 1; i < polyline.size(); ++i) {
    const Vec2 a = ToLocal(passage.frame, polyline[i - 1]);
    const Vec2 b = ToLocal(passage.frame, polyline[i]);
    if ((a.x() < 0.0) != (b.x() < 0.0)) {
      crossings += passage.side * CrossingY(a, b) > 0.0 ? 1 : 0;
    }
  }
  return crossings % 2 == 1;
}

BezierCurve Fit(const CurveProblem& problem, const std::vector<Vec2>& polyline) {
  TRACKBED_CHECK(polyline.size() >= 2, "{} points", polyline.size());
  const EndConditions ends(problem);
  const double seventh = PolylineLength(polyline) / kDegree / ends.scale();
  std::array<double, kVariables> x{seventh, seventh, 0.0, 0.0, 0.0, 0.0, seventh, seventh};
  Points points = ends.ToPoints(x);
  // Subtract the contribution of the known control points from the polyline, then fit the control
  // points P_3 and P_4 to the remainder.
  constexpr Eigen::Index kSamples = BasisSamples::kSamples;
  const auto& bernstein = BernsteinBasis().of_order[0];
  Eigen::Matrix<double, kSamples, 2> rest;
  const std::vector<Vec2> samples = Evenly(polyline, kSamples);
  for (Eigen::Index k = 0; k < kSamples; ++k) {
    Vec2 known = Vec2::Zero();
    for (const std::size_t i : {0U, 1U, 2U, 5U, 6U, 7U}) {
      known += bernstein(k, static_cast<Eigen::Index>(i)) * points[i];
    }
    rest.row(k) = (problem.Frame().In(samples[static_cast<std::size_t>(k)]) - known).transpose();
  }
  const Eigen::Matrix<double, kSamples, 2> free = bernstein.middleCols<2>(3);
  const Eigen::Matrix2d fitted = free.colPivHouseholderQr().solve(rest);
  points[3] = fitted.row(0).transpose();
  points[4] = fitted.row(1).transpose();
  return InWorld(problem, points);
}

}  // namespace trackbed::avoidance
