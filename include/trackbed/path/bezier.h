#pragma once

#include <array>
#include <vector>

#include "trackbed/path/path.h"

namespace trackbed {

/// A Bezier curve P(u) = sum C(n,i) (1-u)^(n-i) u^i P_i over u in [0, 1]. The degree n of the curve
/// is the number of control points minus 1. The local path of Skackauskas (dissertation, listing
/// F.2) has degree 7.
///
/// Evaluation and derivatives are exact to rounding (Bernstein form, no differences). The curvature
/// is positive to the left. The curvature is not finite at points without a direction (P'(u) = 0).
class BezierCurve {
 public:
  /// InternalError unless there are at least two control points, all finite.
  explicit BezierCurve(std::vector<Vec2> control_points);

  [[nodiscard]] const std::vector<Vec2>& control_points() const { return polygons_[0]; }

  /// The point P(u) [m].
  [[nodiscard]] Vec2 At(double u) const { return Derivative(u, 0); }
  /// The derivative d^order P/du^order [m], order 0 to 3.
  [[nodiscard]] Vec2 Derivative(double u, std::size_t order) const;
  /// The curvature kappa(u) [1/m].
  [[nodiscard]] double Curvature(double u) const;
  /// The sharpness dkappa/ds at u [1/m^2].
  [[nodiscard]] double Sharpness(double u) const;
  /// The arc length between two parameters [m]. The relative error is 1e-10 for curves that a car
  /// can drive.
  [[nodiscard]] double Length(double from = 0.0, double to = 1.0) const;

  /// Returns points at most `spacing` [m] apart along the curve, including both ends. Headings are
  /// continuous, starting at `start_yaw`, which must equal the heading of the first tangent up to
  /// full turns. InternalError if a point has no direction; a cusp between two points is not
  /// detected. PreconditionError for more than 10^6 points.
  [[nodiscard]] std::vector<CurvePoint> Points(double spacing, double start_yaw) const;

 private:
  std::array<std::vector<Vec2>, 4> polygons_;  // Control polygons of the curve and its derivatives.
};

/// Curvature kappa [1/m] and sharpness dkappa/ds [1/m^2] of a curve, from its derivatives P', P'',
/// P''' with respect to any parameter.
double CurvatureFromDerivatives(const Vec2& first, const Vec2& second);
double SharpnessFromDerivatives(const Vec2& first, const Vec2& second, const Vec2& third);

}  // namespace trackbed
