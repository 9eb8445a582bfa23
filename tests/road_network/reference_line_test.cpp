#include "trackbed/road_network/reference_line.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

// Rounding error of a few operations on coordinates below 100 m.
constexpr double kRoundingOfLines = 1e-12;
// ParametricCubic has a relative accuracy of 1e-9 of the curve's length, which is below 100 m here.
constexpr double kCurveAccuracy = 1e-7;

ReferenceLine Clothoid(const Pose2& start, double length, double from, double to) {
  return ReferenceLine({{.s = 0.0,
                         .length = length,
                         .start = start,
                         .curve = Path(start, {{.length = length,
                                                .curvature = from,
                                                .direction = 1,
                                                .sharpness = (to - from) / length}})}});
}

TEST(PiecewiseCubic, IsThePolynomialOfThePieceInForce) {
  const PiecewiseCubic function({{2.0, {1.0, 0.5, 0.25, 0.125}}, {4.0, {7.0, 0.0, 0.0, 0.0}}});
  EXPECT_EQ(function.At(1.9).value, 0.0);
  const CubicValue at = function.At(3.0);
  EXPECT_EQ(at.value, 1.875);
  EXPECT_EQ(at.slope, 0.5 + 0.5 + 0.375);
  EXPECT_EQ(at.second, 0.5 + 0.75);
  EXPECT_EQ(function.At(4.0).value, 7.0);
  // Just before the joint at 4, the first polynomial applies, at d = 2 from its start.
  EXPECT_EQ(function.At(4.0, 3.9).value, 1.0 + 1.0 + 1.0 + 1.0);
  EXPECT_EQ(PiecewiseCubic().At(3.0).value, 0.0);
}

TEST(PiecewiseCubic, TakesTheLastOfPiecesAtOneStation) {
  const PiecewiseCubic function({{0.0, {1.0, 0, 0, 0}}, {0.0, {2.0, 0, 0, 0}}});
  EXPECT_EQ(function.At(0.0).value, 2.0);
  EXPECT_THROW(PiecewiseCubic({{1.0, {}}, {0.0, {}}}), InternalError);
}

TEST(ReferenceLine, OfAnArcLiesOnItsCircle) {
  const double radius = -40.0;
  const ReferenceLine line = Clothoid({3.0, 4.0, 0.7}, 60.0, 1.0 / radius, 1.0 / radius);
  const Vec2 center = Vec2(3.0, 4.0) + radius * LeftNormal(Direction(0.7));
  for (const double s : {0.0, 10.0, 33.0, 60.0}) {
    const ReferenceLinePoint at = line.At(s);
    EXPECT_NEAR((at.pose.position() - center).norm(), 40.0, Tolerance(kRoundingOfLines));
    EXPECT_NEAR(at.pose.yaw, 0.7 + s / radius, Tolerance(kRoundingOfLines));
    EXPECT_NEAR(at.curvature, 1.0 / radius, Tolerance(kRoundingOfLines));
    EXPECT_EQ(at.stretch, 1.0);
  }
}

/// Computes the point at the distance s along a clothoid whose heading is c s^2, from the power
/// series of Fresnel's integrals: x = sum (-1)^n c^2n s^(4n+1)/((2n)! (4n+1)), y = sum (-1)^n
/// c^(2n+1) s^(4n+3)/((2n+1)! (4n+3)).
Vec2 ClothoidBySeries(double c, double s) {
  Vec2 sum(0.0, 0.0);
  double term = s;  // The value of c^m s^(2m+1)/m!, without the sign.
  for (int m = 0; m < 40; ++m) {
    const double sign = m % 4 < 2 ? 1.0 : -1.0;
    (m % 2 == 0 ? sum.x() : sum.y()) += sign * term / (2 * m + 1);
    term *= c * s * s / (m + 1);
  }
  return sum;
}

TEST(ReferenceLine, OfASpiralIsFresnelsIntegral) {
  const double length = 50.0;
  const double curvature = 0.04;
  const ReferenceLine line = Clothoid({}, length, 0.0, curvature);
  for (const double s : {5.0, 20.0, 35.0, 50.0}) {
    const ReferenceLinePoint at = line.At(s);
    const Vec2 expected = ClothoidBySeries(0.5 * curvature / length, s);
    // The header of the function states this accuracy for curves other than lines and arcs.
    EXPECT_NEAR((at.pose.position() - expected).norm(), 0.0, Tolerance(1e-9)) << s;
    EXPECT_NEAR(at.pose.yaw, 0.5 * curvature / length * s * s, Tolerance(kRoundingOfLines));
    EXPECT_NEAR(at.curvature, curvature * s / length, Tolerance(kRoundingOfLines));
  }
}

/// Returns the arc length of the parabola v = a u^2 from 0 to u.
double ParabolaLength(double a, double u) {
  const double slope = 2.0 * a * u;
  return 0.5 * u * std::hypot(1.0, slope) + std::asinh(slope) / (4.0 * a);
}

void ExpectOnParabola(const ParametricCubic& curve, double a, double distance, double u) {
  const ParametricCubic::Point at = curve.At(distance);
  const double slope = 2.0 * a * u;
  const double speed = std::hypot(1.0, slope);
  EXPECT_NEAR(at.position.x(), u, Tolerance(kCurveAccuracy));
  EXPECT_NEAR(at.position.y(), a * u * u, Tolerance(kCurveAccuracy));
  EXPECT_NEAR(at.heading, std::atan(slope), Tolerance(kCurveAccuracy));
  // The curvature is kappa = 2a/(1 + 4a^2u^2)^(3/2). The sharpness is the derivative of kappa with
  // respect to u, divided by `speed`.
  EXPECT_NEAR(at.curvature, 2.0 * a / std::pow(speed, 3), Tolerance(kCurveAccuracy));
  EXPECT_NEAR(at.sharpness, -24.0 * a * a * a * u / std::pow(speed, 6), Tolerance(kCurveAccuracy));
}

TEST(ParametricCubic, IsAParabolaByArcLength) {
  const double a = 0.02;
  const double end = 40.0;
  const double length = ParabolaLength(a, end);
  const ParametricCubic normalized({0.0, end, 0.0, 0.0}, {0.0, 0.0, a * end * end, 0.0}, 1.0,
                                   length);
  const ParametricCubic over_u = ParametricCubic::OverU({0.0, 0.0, a, 0.0}, length);
  EXPECT_NEAR(normalized.arc_length(), length, Tolerance(1e-9 * length));
  for (const double u : {0.0, 3.0, 17.0, 31.0, 40.0}) {
    SCOPED_TRACE(u);
    ExpectOnParabola(normalized, a, ParabolaLength(a, u), u);
    ExpectOnParabola(over_u, a, ParabolaLength(a, u), u);
  }
}

TEST(ParametricCubic, StretchesItsStationsToTheLengthOfTheFile) {
  const double a = 0.02;
  const double whole = ParabolaLength(a, 40.0);
  const ParametricCubic curve({0.0, 1.0, 0.0, 0.0}, {0.0, 0.0, a, 0.0}, 40.0, 0.99 * whole);
  ExpectOnParabola(curve, a, 0.99 * ParabolaLength(a, 25.0), 25.0);
  ExpectOnParabola(curve, a, 0.99 * whole, 40.0);
}

TEST(ParametricCubic, InvertsArcLengthOfAnyCurve) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const std::array<double, 4> u{0.0, 30.0, random.Uniform(-9, 9), random.Uniform(-9, 9)};
    const std::array<double, 4> v{0.0, 0.0, random.Uniform(-9, 9), random.Uniform(-9, 9)};
    const ParametricCubic unit(u, v, 1.0, 1.0);
    const ParametricCubic curve(u, v, 1.0, unit.arc_length());
    // A chord of a curve over the arc length h is shorter than h by kappa^2 h^3/24. With kappa
    // below 0.1 1/m and 4000 steps of h = 0.01 m, the sum of the differences is below 4000 x 0.01 x
    // 1e-6/24 = 2e-6 m.
    double chords = 0.0;
    constexpr int kSteps = 4000;
    Vec2 before = curve.At(0.0).position;
    for (int k = 1; k <= kSteps; ++k) {
      const Vec2 next = curve.At(curve.arc_length() * k / kSteps).position;
      const double chord = (next - before).norm();
      EXPECT_NEAR(chord, curve.arc_length() / kSteps, Tolerance(1e-7));
      chords += chord;
      before = next;
    }
    EXPECT_NEAR(chords, curve.arc_length(), Tolerance(2e-6));
  }
}

TEST(ParametricCubic, RefusesACurveThatIsAPoint) {
  EXPECT_THROW(ParametricCubic({1.0, 0.0, 0.0, 0.0}, {}, 1.0, 1.0), InternalError);
}

TEST(ReferenceLine, PlacesCurvesInTheFrameOfTheirStart) {
  const Pose2 start{5.0, -2.0, kPi / 2.0};
  const ParametricCubic curve({0.0, 10.0, 0.0, 0.0}, {0.0, 0.0, 2.0, 0.0}, 1.0, 10.0);
  const ReferenceLine line({{.s = 1.0, .length = 10.0, .start = start, .curve = curve}});
  const ReferenceLinePoint end = line.At(11.0);
  EXPECT_NEAR((end.pose.position() - Vec2(3.0, 8.0)).norm(), 0.0, Tolerance(kCurveAccuracy));
  EXPECT_NEAR(end.pose.yaw, kPi / 2.0 + std::atan(0.4), Tolerance(kCurveAccuracy));
  EXPECT_NEAR(end.stretch, curve.arc_length() / 10.0, Tolerance(kRoundingOfLines));
}

TEST(ReferenceLine, ChoosesThePieceInForce) {
  const ReferenceLine line(
      {{.s = 0.0, .length = 10.0, .start = {}, .curve = Path({}, {{10.0, 0.0}})},
       {.s = 10.0,
        .length = 10.0,
        .start = {10.0, 0.5, 0.0},
        .curve = Path({10.0, 0.5, 0.0}, {{10.0, 0.1}})}});
  EXPECT_EQ(line.At(10.0).pose.y, 0.5);
  EXPECT_EQ(line.At(10.0, 9.0).pose.y, 0.0);
  EXPECT_EQ(line.At(10.0, 9.0).curvature, 0.0);
}

}  // namespace
}  // namespace trackbed
