#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <span>

#include "src/planning/avoidance/avoidance_curve.h"
#include "trackbed/path/bezier.h"

/// Variables that describe a degree-7 Bezier curve between given ends, and the Bernstein basis at
/// the samples of the curve.
namespace trackbed::avoidance {

inline constexpr std::size_t kDegree = 7;

/// Variables of the search: the coordinates of the control points that the end conditions do not
/// fix. The variables are lengths in the mirror frame of the start, divided by the distance between
/// the curve's ends.
enum Variable : std::size_t {
  kStartFirst,
  kStartSecond,
  kX3,
  kY3,
  kX4,
  kY4,
  kEndSecond,
  kEndFirst
};
inline constexpr std::size_t kVariables = 8;
using Variables = std::span<const double>;

using Points = std::array<Vec2, kDegree + 1>;

/// Maps variables to the control points P_0 to P_7, in the mirror frame of the start. The control
/// point P_1 lies on the tangent at the start of the curve. The offset h of P_2 from the tangent
/// follows from the curvature at the start: kappa = (6/7) h/|P_0 P_1|^2. The offset of P_5 from the
/// tangent at the end follows from the curvature at the end by the same equation.
class EndConditions {
 public:
  explicit EndConditions(const CurveProblem& problem);

  /// Returns the distance between the curve's ends [m].
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] Points ToPoints(Variables x) const;
  [[nodiscard]] std::array<double, kVariables> ToVariables(const Points& p) const;

 private:
  double scale_;
  double start_curvature_;
  double end_curvature_;
  Vec2 end_;
  Vec2 forward_;
};

/// Values of the Bernstein polynomials of degree 7 and of their first three derivatives at evenly
/// spaced parameters.
struct BasisSamples {
  static constexpr Eigen::Index kSamples = 193;
  using Matrix = Eigen::Matrix<double, kSamples, kDegree + 1>;
  std::array<Matrix, 4> of_order;

  BasisSamples();
};

/// Returns the samples of the basis, which are computed once.
const BasisSamples& BernsteinBasis();

/// Converts control points from the mirror frame of the start to a curve in the world frame.
BezierCurve InWorld(const CurveProblem& problem, const Points& points);

}  // namespace trackbed::avoidance
