#include "trackbed/path/bezier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

// Tests Bezier curves against closed forms (parabola, quarter circle), against the sum of Bernstein
// polynomials, and against finite differences. Tests their conversion to points and path segments.
namespace trackbed {
namespace {

// Rounding error [m] of some tens of operations on coordinates below 30 m.
constexpr double kRounding = 1e-13;

/// Returns the control points of a lane change within 30 m. The curve starts at (0, 0) with heading
/// east, and ends in a lane 8 m to the left.
std::vector<Vec2> LaneChange() {
  return {{0, 0}, {5, 0}, {10, 0}, {14, 0.5}, {16, 7.5}, {20, 8}, {25, 8}, {30, 8}};
}

std::vector<Vec2> RandomPoints(Random& random, std::size_t count) {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(random.Uniform(-10.0, 10.0), random.Uniform(-10.0, 10.0));
  }
  return points;
}

/// Returns random control points of a curve without loops: each point is ahead of the previous one.
std::vector<Vec2> RandomRun(Random& random, std::size_t count) {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(4.0 * static_cast<double>(i) + random.Uniform(-0.5, 0.5),
                        random.Uniform(-3.0, 3.0));
  }
  return points;
}

// --- At
// --------------------------------------------------------------------------------------------

TEST(Bezier, OfTwoPointsIsTheLineBetween) {
  const BezierCurve line({{1.0, 2.0}, {5.0, -1.0}});
  for (const double u : {0.0, 0.25, 0.7, 1.0}) {
    EXPECT_NEAR((line.At(u) - Vec2{1.0 + 4.0 * u, 2.0 - 3.0 * u}).norm(), 0.0,
                Tolerance(kRounding));
    EXPECT_EQ(line.Derivative(u, 1), Vec2(4.0, -3.0));
    EXPECT_EQ(line.Derivative(u, 2), Vec2(0.0, 0.0));
    EXPECT_EQ(line.Derivative(u, 3), Vec2(0.0, 0.0));
    EXPECT_EQ(line.Curvature(u), 0.0);
    EXPECT_EQ(line.Sharpness(u), 0.0);
  }
  EXPECT_NEAR(line.Length(), 5.0, Tolerance(kRounding));
  EXPECT_NEAR(line.Length(0.25, 0.5), 1.25, Tolerance(kRounding));
}

TEST(Bezier, OfThreePointsIsAParabola) {
  // The parabola y = x^2 over [-1, 1] has the curvature kappa = 2/(1 + 4x^2)^(3/2) and the
  // curvature rate dkappa/ds = -24 x/(1 + 4x^2)^3.
  const BezierCurve parabola({{-1.0, 1.0}, {0.0, -1.0}, {1.0, 1.0}});
  for (double x = -1.0; x <= 1.0; x += 0.125) {
    const double u = 0.5 * (x + 1.0);
    const double square = 1.0 + 4.0 * x * x;
    EXPECT_NEAR((parabola.At(u) - Vec2{x, x * x}).norm(), 0.0, Tolerance(kRounding));
    EXPECT_NEAR(parabola.Curvature(u), 2.0 * std::pow(square, -1.5), Tolerance(kRounding));
    EXPECT_NEAR(parabola.Sharpness(u), -24.0 * x * std::pow(square, -3.0), Tolerance(kRounding));
  }
  // The arc length of the parabola is (2x sqrt(1 + 4x^2) + asinh 2x)/4, evaluated from -1 to 1.
  const double length = std::sqrt(5.0) + 0.5 * std::asinh(2.0);
  EXPECT_NEAR(parabola.Length(), length, Tolerance(1e-10 * length));
}

TEST(Bezier, OfEightPointsIsBernsteinsSum) {
  constexpr std::array<double, 8> kBinomials{1, 7, 21, 35, 35, 21, 7, 1};
  Random random(61);
  for (int i = 0; i < 100; ++i) {
    const std::vector<Vec2> points = RandomPoints(random, 8);
    const double u = random.Uniform(0.0, 1.0);
    Vec2 sum{0.0, 0.0};
    for (int k = 0; k < 8; ++k) {
      const auto index = static_cast<std::size_t>(k);
      sum += kBinomials[index] * std::pow(1.0 - u, 7 - k) * std::pow(u, k) * points[index];
    }
    EXPECT_NEAR((BezierCurve(points).At(u) - sum).norm(), 0.0, Tolerance(kRounding));
  }
}

TEST(Bezier, BeginsAndEndsAtItsOuterPointsAlongItsOuterSides) {
  Random random(62);
  for (const std::size_t degree : {1U, 2U, 3U, 7U, 11U}) {
    const std::vector<Vec2> points = RandomPoints(random, degree + 1);
    const BezierCurve curve(points);
    const auto n = static_cast<double>(degree);
    EXPECT_EQ(curve.At(0.0), points.front());
    EXPECT_EQ(curve.At(1.0), points.back());
    EXPECT_NEAR((curve.Derivative(0.0, 1) - n * (points[1] - points[0])).norm(), 0.0,
                Tolerance(kRounding));
    EXPECT_NEAR((curve.Derivative(1.0, 1) - n * (points[degree] - points[degree - 1])).norm(), 0.0,
                Tolerance(kRounding));
  }
}

TEST(Bezier, DerivativesAreThoseOfItsPoints) {
  Random random(63);
  for (int i = 0; i < 50; ++i) {
    const BezierCurve curve(RandomPoints(random, 8));
    constexpr double kStep = 1e-4;
    const double u = random.Uniform(kStep, 1.0 - kStep);
    // The derivative of order m is at most 7!/(7 - m)! times the largest m-th difference of the
    // control points, which is at most 2^m 10 sqrt(2) m. The error of a central difference is h^2/6
    // times the derivative two orders higher. For the first derivative, the error is below 210 x 8
    // x 14.2 h^2/6 m. The bounds for the second and the third derivative are 8 and 48 times larger.
    double most = 210.0 * 8.0 * 14.2 * kStep * kStep / 6.0;
    for (std::size_t order = 1; order <= 3; ++order) {
      const Vec2 difference =
          (curve.Derivative(u + kStep, order - 1) - curve.Derivative(u - kStep, order - 1)) /
          (2.0 * kStep);
      EXPECT_NEAR((difference - curve.Derivative(u, order)).norm(), 0.0, Tolerance(most));
      most *= 2.0 * (order == 1 ? 4.0 : 3.0);
    }
  }
}

TEST(Bezier, MovesTurnsAndGrowsWithItsPoints) {
  Random random(64);
  for (int i = 0; i < 50; ++i) {
    const std::vector<Vec2> points = RandomRun(random, 8);
    const Pose2 moved{random.Uniform(-5.0, 5.0), random.Uniform(-5.0, 5.0),
                      random.Uniform(-3.0, 3.0)};
    const double scale = random.Uniform(0.5, 2.0);
    std::vector<Vec2> others;
    for (const Vec2& point : points) {
      others.push_back(ToWorld(moved, scale * point));
    }
    const BezierCurve curve(points);
    const BezierCurve other(others);
    for (const double u : {0.0, 0.3, 0.8, 1.0}) {
      EXPECT_NEAR((other.At(u) - ToWorld(moved, scale * curve.At(u))).norm(), 0.0,
                  Tolerance(kRounding));
      // The parameter speed |P'| exceeds 10 m, so division by powers of |P'| keeps twelve digits.
      EXPECT_NEAR(other.Curvature(u), curve.Curvature(u) / scale, Tolerance(1e-12));
      EXPECT_NEAR(other.Sharpness(u), curve.Sharpness(u) / (scale * scale), Tolerance(1e-12));
    }
    EXPECT_NEAR(other.Length(), scale * curve.Length(), Tolerance(1e-12));
  }
}

TEST(Bezier, AnyAffineMapOfItsPointsMapsIt) {
  Random random(65);
  const std::vector<Vec2> points = RandomPoints(random, 8);
  const auto map = [](const Vec2& p) {
    return Vec2{1.5 * p.x() - 0.4 * p.y() + 3.0, 0.2 * p.x() - 2.0 * p.y() - 1.0};
  };
  std::vector<Vec2> mapped;
  for (const Vec2& point : points) {
    mapped.push_back(map(point));
  }
  for (double u = 0.0; u <= 1.0; u += 0.125) {
    EXPECT_NEAR((BezierCurve(mapped).At(u) - map(BezierCurve(points).At(u))).norm(), 0.0,
                Tolerance(kRounding));
  }
}

TEST(Bezier, RunTheOtherWayTurnsTheOtherWay) {
  Random random(66);
  for (int i = 0; i < 50; ++i) {
    std::vector<Vec2> points = RandomRun(random, 8);
    const BezierCurve curve(points);
    std::reverse(points.begin(), points.end());
    const BezierCurve back(points);
    for (const double u : {0.0, 0.2, 0.5, 0.9, 1.0}) {
      EXPECT_NEAR((back.At(1.0 - u) - curve.At(u)).norm(), 0.0, Tolerance(kRounding));
      EXPECT_NEAR(back.Curvature(1.0 - u), -curve.Curvature(u), Tolerance(1e-12));
      // On the reversed curve, both the curvature and the direction of increasing station change
      // their sign, so the sharpness keeps its sign.
      EXPECT_NEAR(back.Sharpness(1.0 - u), curve.Sharpness(u), Tolerance(1e-12));
    }
    EXPECT_NEAR(back.Length(), curve.Length(), Tolerance(1e-12));
  }
}

// --- Curvature, sharpness, length
// --------------------------------------------------------------------------------------------

TEST(Bezier, NearAQuarterCircleCurvesLikeIt) {
  // The cubic curve with control polygon sides of r 4/3 (sqrt(2) - 1) at both ends approximates a
  // quarter circle of radius r to 2.8e-4 r. Its curvature differs from 1/r by at most 3 % (0.6 % at
  // the ends and in the middle).
  constexpr double kRadius = 10.0;
  const double side = kRadius * 4.0 / 3.0 * (std::sqrt(2.0) - 1.0);
  const BezierCurve left({{kRadius, 0.0}, {kRadius, side}, {side, kRadius}, {0.0, kRadius}});
  const BezierCurve right({{0.0, kRadius}, {side, kRadius}, {kRadius, side}, {kRadius, 0.0}});
  for (double u = 0.0; u <= 1.0; u += 1.0 / 64.0) {
    EXPECT_NEAR(left.At(u).norm(), kRadius, 2.8e-4 * kRadius);
    EXPECT_NEAR(left.Curvature(u), 1.0 / kRadius, 0.03 / kRadius);
    EXPECT_NEAR(right.Curvature(u), -1.0 / kRadius, 0.03 / kRadius);
  }
  // The curvature at the end is exactly 2/3 |cross(side, next)|/side^3, where `side` is the first
  // and `next` the second side of the control polygon.
  const Vec2 next{side - kRadius, kRadius - side};
  EXPECT_NEAR(left.Curvature(0.0), 2.0 / 3.0 * (kRadius - side) / (side * side),
              Tolerance(kRounding));
  EXPECT_NEAR(left.Length(), kRadius * kPi / 2.0, 2.8e-4 * kRadius * kPi / 2.0);
}

TEST(Bezier, SharpnessIsTheCurvaturesGrowthAlongTheCurve) {
  const BezierCurve curve(LaneChange());
  constexpr double kStep = 1e-4;
  for (double u = 0.05; u < 1.0; u += 0.05) {
    const double growth = (curve.Curvature(u + kStep) - curve.Curvature(u - kStep)) /
                          curve.Length(u - kStep, u + kStep);
    // The error of the quotient is h^2/6 times the third derivatives of the curvature (below 2e3
    // 1/m) and of the length, divided by the parameter speed |P'| (above 15 m). Rounding adds
    // 1e-15/h.
    EXPECT_NEAR(growth, curve.Sharpness(u), Tolerance(1e-6));
  }
}

TEST(Bezier, LengthIsThatOfAFinePolyline) {
  Random random(67);
  std::vector<std::vector<Vec2>> cases{LaneChange()};
  for (int i = 0; i < 20; ++i) {
    cases.push_back(RandomRun(random, 8));
  }
  for (const std::vector<Vec2>& points : cases) {
    const BezierCurve curve(points);
    // A chord is shorter than its arc ds by ds^3 kappa^2/24, so halving the chords reduces the
    // error to a quarter. Extrapolation from both polylines leaves an error of fourth order.
    const auto polyline = [&](int pieces) {
      double length = 0.0;
      for (int i = 0; i < pieces; ++i) {
        length += (curve.At(static_cast<double>(i + 1) / pieces) -
                   curve.At(static_cast<double>(i) / pieces))
                      .norm();
      }
      return length;
    };
    const double coarse = polyline(2000);
    const double fine = polyline(4000);
    EXPECT_NEAR(curve.Length(), fine + (fine - coarse) / 3.0, Tolerance(1e-10 * fine));
    EXPECT_NEAR(curve.Length(0.0, 0.37) + curve.Length(0.37, 1.0), curve.Length(),
                Tolerance(1e-10 * fine));
    EXPECT_NEAR(curve.Length(0.8, 0.2), -curve.Length(0.2, 0.8), Tolerance(1e-12));
  }
}

TEST(Bezier, LengthOfALineIsExactHoweverItIsRunAlong) {
  // The control points lie on a straight line, so |P'| is a polynomial of degree 6, which the
  // quadrature integrates exactly.
  std::vector<Vec2> points;
  for (const double t : {0.0, 0.5, 2.0, 2.5, 4.0, 7.0, 9.0, 10.0}) {
    points.emplace_back(1.0 + 3.0 * t, -2.0 + 4.0 * t);
  }
  EXPECT_NEAR(BezierCurve(points).Length(), 50.0, Tolerance(1e-12));
}

// --- Points
// --------------------------------------------------------------------------------------------

TEST(BezierPoints, KeepTheSpacingAndBothEnds) {
  Random random(68);
  for (int i = 0; i < 20; ++i) {
    const BezierCurve curve(RandomRun(random, 8));
    const Vec2 start = curve.Derivative(0.0, 1);
    for (const double spacing : {0.1, 1.0, 100.0}) {
      const std::vector<CurvePoint> points =
          curve.Points(spacing, std::atan2(start.y(), start.x()));
      ASSERT_GE(points.size(), 2U);
      EXPECT_EQ(points.front().s, 0.0);
      EXPECT_NEAR(points.back().s, curve.Length(), Tolerance(1e-10 * curve.Length()));
      for (std::size_t k = 1; k < points.size(); ++k) {
        EXPECT_GT(points[k].s, points[k - 1].s);
        EXPECT_LE(points[k].s - points[k - 1].s, spacing * (1.0 + 1e-12));
      }
      EXPECT_EQ(points.front().curvature, curve.Curvature(0.0));
      EXPECT_EQ(points.back().curvature, curve.Curvature(1.0));
    }
  }
}

TEST(BezierPoints, HeadingsGoOnThroughMoreThanAFullTurn) {
  // The loop turns by 2 pi + 0.93 rad. The initial heading already includes two full turns.
  const BezierCurve loop({{0, 0}, {40, 0}, {40, 40}, {-40, 40}, {-40, -30}, {50, -30}, {53, -26}});
  const std::vector<CurvePoint> points = loop.Points(0.1, 4.0 * kPi);
  double turned = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_LT(std::abs(points[i].yaw - points[i - 1].yaw), 0.5);
    turned +=
        0.5 * (points[i].curvature + points[i - 1].curvature) * (points[i].s - points[i - 1].s);
  }
  EXPECT_EQ(points.front().yaw, 4.0 * kPi);
  EXPECT_NEAR(points.back().yaw, 6.0 * kPi + std::atan2(4.0, 3.0), Tolerance(1e-12));
  // The heading change equals the integral of the curvature, which the test computes by the
  // trapezoidal rule with steps of 0.1 m.
  EXPECT_NEAR(points.back().yaw - points.front().yaw, turned, Tolerance(1e-3));
}

TEST(BezierPoints, NeedADirection) {
  const BezierCurve point({{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}});
  EXPECT_THROW((void)point.Points(0.1, 0.0), InternalError);
  EXPECT_FALSE(std::isfinite(point.Curvature(0.5)));
  const BezierCurve still({{0.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}});  // The derivative
                                                                              // P'(0) is 0.
  EXPECT_THROW((void)still.Points(0.1, 0.0), InternalError);
  EXPECT_THROW((void)BezierCurve(LaneChange()).Points(0.0, 0.0), InternalError);
}

TEST(BezierPoints, MakeSegmentsThatFollowTheCurve) {
  Random random(69);
  std::vector<std::vector<Vec2>> cases{LaneChange()};
  for (int i = 0; i < 20; ++i) {
    cases.push_back(RandomRun(random, 8));
  }
  for (const std::vector<Vec2>& control_points : cases) {
    const BezierCurve curve(control_points);
    const Vec2 velocity = curve.Derivative(0.0, 1);
    const double yaw = std::atan2(velocity.y(), velocity.x());
    const Pose2 start{curve.At(0.0).x(), curve.At(0.0).y(), yaw};
    const Path path(start, SegmentsThrough(curve.Points(0.1, yaw)));
    // The documentation of SegmentsThrough states an error of about 1e-7 m over the bends of a
    // car's path.
    EXPECT_NEAR((path.At(path.length()).pose.position() - curve.At(1.0)).norm(), 0.0,
                Tolerance(1e-6));
    for (const double u : {0.25, 0.5, 0.75}) {
      const PathPoint at = path.At(curve.Length(0.0, u));
      EXPECT_NEAR((at.pose.position() - curve.At(u)).norm(), 0.0, Tolerance(1e-6));
      EXPECT_NEAR(at.curvature, curve.Curvature(u), Tolerance(1e-4));
    }
  }
}

TEST(Bezier, ChecksItsPoints) {
  EXPECT_THROW(BezierCurve(std::vector<Vec2>{}), InternalError);
  EXPECT_THROW(BezierCurve({{1.0, 2.0}}), InternalError);
  EXPECT_THROW(BezierCurve({{1.0, 2.0}, {std::nan(""), 0.0}}), InternalError);
  EXPECT_THROW(BezierCurve({{1.0, 2.0}, {HUGE_VAL, 0.0}}), InternalError);
}

}  // namespace
}  // namespace trackbed
