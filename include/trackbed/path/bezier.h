#pragma once

#include <array>
#include <vector>

#include "trackbed/path/path.h"

namespace trackbed {

/// A Bezier curve P(u) = sum C(n,i) (1-u)^(n-i) u^i P_i with the control points P_i and the
/// parameter u in [0, 1]. The degree n of the curve is the number of control points minus 1. The
/// local path in Skackauskas' dissertation (listing F.2) is a Bezier curve of degree 7.
///
/// Points and derivatives of the curve are exact except for rounding errors, because the Bernstein
/// form is evaluated without finite differences. The curvature is positive where the curve turns to
/// the left. The curvature is not finite at points without a direction (P'(u) = 0).
class BezierCurve {
 public:
  /// Throws InternalError if there are fewer than two control points or a control point is not
  /// finite.
  explicit BezierCurve(std::vector<Vec2> control_points);

  [[nodiscard]] const std::vector<Vec2>& control_points() const { return polygons_[0]; }

  /// Returns the curve's point P(u) [m].
  [[nodiscard]] Vec2 At(double u) const { return Derivative(u, 0); }
  /// Returns the derivative d^order P/du^order [m]; `order` is 0 to 3.
  [[nodiscard]] Vec2 Derivative(double u, std::size_t order) const;
  /// Returns the curvature kappa(u) [1/m].
  [[nodiscard]] double Curvature(double u) const;
  /// Returns the sharpness dkappa/ds (curvature rate over arc length) at u [1/m^2].
  [[nodiscard]] double Sharpness(double u) const;
  /// Returns the arc length of the curve between two parameters [m]. For curves that a car can
  /// drive, the relative error of the arc length is 1e-10.
  [[nodiscard]] double Length(double from = 0.0, double to = 1.0) const;

  /// Returns points at most `spacing` [m] apart along the curve, including both ends. The heading
  /// is continuous along the points, starting at `start_yaw`; `start_yaw` must equal the heading of
  /// the first tangent, except for full turns. Throws InternalError if the curve has no direction
  /// at one of the returned points; a cusp between two of the returned points is not detected.
  /// Throws PreconditionError if more than 10^6 points are needed.
  [[nodiscard]] std::vector<CurvePoint> Points(double spacing, double start_yaw) const;

 private:
  // Control points of the curve and of the curve's derivatives.
  std::array<std::vector<Vec2>, 4> polygons_;
};

/// Computes the curvature kappa [1/m] and the sharpness dkappa/ds [1/m^2] of a curve from the
/// curve's derivatives P', P'', P''' with respect to any parameter.
double CurvatureFromDerivatives(const Vec2& first, const Vec2& second);
double SharpnessFromDerivatives(const Vec2& first, const Vec2& second, const Vec2& third);

}  // namespace trackbed
