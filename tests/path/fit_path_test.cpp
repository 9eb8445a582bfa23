#include "trackbed/path/fit_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

// Tests the fit of a path to points by quintic splines. Compares the curvature with that of
// circles, a lemniscate and clothoids, checks the order of convergence, and checks the deviation
// from random points.
namespace trackbed {
namespace {

using ::testing::HasSubstr;

PathPoints PointsOn(const std::function<Vec2(double)>& curve, int count) {
  PathPoints given;
  for (int i = 0; i < count; ++i) {
    given.points.push_back(curve(static_cast<double>(i) / (count - 1)));
  }
  return given;
}

PathPoints Arc(double radius, double angle, int count) {
  return PointsOn(
      [&](double t) {
        return Vec2(radius * std::sin(angle * t), radius * (1.0 - std::cos(angle * t)));
      },
      count);
}

double LargestDistance(const FittedPath& fitted) {
  double largest = 0.0;
  for (const Vec2& point : fitted.given.points) {
    const Projection nearest = fitted.path.Project({point.x(), point.y(), 0.0});
    largest = std::max(largest, (fitted.path.At(nearest.s).pose.position() - point).norm());
  }
  return largest;
}

/// Returns the largest curvature error of the path at the given points, including the ends.
double CurvatureError(const FittedPath& fitted, const std::function<double(double)>& curvature) {
  double largest = 0.0;
  const std::size_t count = fitted.stations.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double own = fitted.path.At(fitted.stations[i] - (i + 1 == count ? 1e-9 : 0.0)).curvature;
    largest = std::max(largest, std::abs(own - curvature(static_cast<double>(i) /
                                                         static_cast<double>(count - 1))));
  }
  return largest;
}

constexpr PathFitOptions kInterpolate{.max_deviation = 1e-7};

// The second derivative of a quintic interpolant with spacing h has an error of the order h^4
// |P^(6)|. A circle of radius R has |P^(6)| = 1/R^5, so the curvature error is of the order
// h^4/R^5. The spline's natural end conditions (P''' and higher derivatives are 0) do not hold for
// a circle, whose |P'''| is 1/R^2. Near the ends of the path, over a few times h, these end
// conditions change the curvature by at most 0.2 h |P'''|.
TEST(FitPath, FindsTheCurvatureOfACircle) {
  for (const double radius : {5.0, 20.0}) {
    for (const int count : {41, 81}) {
      const double h = radius * 2.0 / (count - 1);
      const FittedPath fitted = FitPath(Arc(radius, 2.0, count), kInterpolate);
      EXPECT_LE(CurvatureError(fitted, [&](double) { return 1.0 / radius; }),
                Tolerance(0.2 * h / (radius * radius)));
      // Skips ten points at each end, because the error caused by the end conditions decreases by
      // the factor 0.43 from point to point.
      double inner = 0.0;
      for (std::size_t i = 10; i + 10 < fitted.stations.size(); ++i) {
        inner =
            std::max(inner, std::abs(fitted.path.At(fitted.stations[i]).curvature - 1.0 / radius));
      }
      EXPECT_LE(inner, Tolerance(0.2 * h / (radius * radius) * std::pow(0.43, 10) +
                                 std::pow(h, 4) / std::pow(radius, 5)));
      EXPECT_NEAR(fitted.path.length(), 2.0 * radius, Tolerance(1e-4));
    }
  }
}

TEST(FitPath, ClosesACircle) {
  constexpr double kRadius = 12.0;
  constexpr int kCount = 60;
  PathPoints given = Arc(kRadius, 2.0 * kPi, kCount + 1);
  for (const bool repeats_start : {true, false}) {
    if (!repeats_start) {
      given.points.pop_back();
    }
    const FittedPath fitted = FitPath(given, {.max_deviation = 1e-7, .closed = true});
    const Path& path = fitted.path;
    const double h = 2.0 * kPi * kRadius / kCount;
    for (const PathPoint& point : path.Sample(0.5)) {
      if (point.s < path.length()) {
        EXPECT_NEAR(point.curvature, 1.0 / kRadius,
                    Tolerance(std::pow(h, 4) / std::pow(kRadius, 5)));
      }
    }
    const PathPoint start = path.At(0.0);
    const PathPoint end = path.At(path.length());
    // The error of approximating the spline by path segments is far below max_deviation.
    EXPECT_NEAR((end.pose.position() - start.pose.position()).norm(), 0.0, Tolerance(1e-6));
    EXPECT_NEAR(AngleDifference(end.pose.yaw, start.pose.yaw), 0.0, Tolerance(1e-9));
    EXPECT_NEAR(fitted.stations.back(), repeats_start ? path.length() : path.length() - h,
                Tolerance(1e-4));
  }
}

// The lemniscate x = a cos t/(1 + sin^2 t), y = x sin t has the curvature 3 cos t/(a sqrt(1 + sin^2
// t)), up to the sign. The lemniscate crosses itself.
TEST(FitPath, FindsTheCurvatureOfALemniscate) {
  constexpr double kA = 20.0;
  const auto curve = [](double t) {
    const double x = kA * std::cos(t) / (1.0 + std::sin(t) * std::sin(t));
    return Vec2(x, x * std::sin(t));
  };
  const auto curvature = [](double t) {
    return 3.0 * std::cos(t) / (kA * std::sqrt(1.0 + std::sin(t) * std::sin(t)));
  };
  double before = 0.0;
  for (const int count : {100, 200}) {
    PathPoints given;
    for (int i = 0; i < count; ++i) {
      given.points.push_back(curve(2.0 * kPi * i / count));
    }
    // With a larger max_deviation, smoothing would change the curvature by more than interpolation
    // does.
    const FittedPath fitted = FitPath(given, {.max_deviation = 1e-8, .closed = true});
    double largest = 0.0;
    for (int i = 0; i < count; ++i) {
      const double own = fitted.path.At(fitted.stations[static_cast<std::size_t>(i)]).curvature;
      largest = std::max(largest, std::abs(own - curvature(2.0 * kPi * i / count)));
    }
    // The error is at most h^4 |P^(6)|, where |P^(6)| of the lemniscate is at most about 100
    // (3/a)^5.
    const double h = fitted.path.length() / count;
    EXPECT_LE(largest, Tolerance(100.0 * std::pow(h, 4) * std::pow(3.0 / kA, 5)));
    if (before > 0.0) {
      EXPECT_LE(largest, before / 8.0);  // The order of convergence is 4: halving the spacing
                                         // divides the error by 16. The factor 8 leaves a margin of
                                         // 2.
    }
    before = largest;
  }
}

TEST(FitPath, FindsTheCurvatureRateOfAClothoid) {
  const Path clothoid({0.0, 0.0, 0.3}, {{.length = 60.0, .sharpness = 0.002}});
  PathPoints given;
  for (double s = 0.0; s <= 60.0; s += 0.5) {
    given.points.push_back(clothoid.At(s).pose.position());
  }
  const FittedPath fitted = FitPath(given, kInterpolate);
  for (double s = 10.0; s <= 50.0; s += 0.25) {
    const PathPoint point = fitted.path.At(s);
    // The error of the third derivative is at most h^3 |P^(6)|, with |P^(6)| < 10 kappa^3 sharpness
    // < 0.02 x 0.1^3 1/m^5.
    EXPECT_NEAR(point.sharpness, 0.002, Tolerance(1e-5));
    EXPECT_NEAR(point.curvature, 0.002 * s, Tolerance(1e-6));
  }
}

TEST(FitPath, KeepsItsDeviationOnRandomPoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> turn(-0.4, 0.4);
  std::uniform_real_distribution<double> length(0.2, 3.0);
  std::uniform_real_distribution<double> noise(-0.03, 0.03);
  for (int run = 0; run < 15; ++run) {
    PathPoints given;
    Pose2 pose;
    for (int i = 0; i < 60; ++i) {
      const double step = length(random);
      given.points.push_back(pose.position() + Vec2(noise(random), noise(random)));
      pose.yaw += turn(random);
      pose = {pose.x + step * std::cos(pose.yaw), pose.y + step * std::sin(pose.yaw), pose.yaw};
    }
    for (const double allowed : {0.01, 0.05, 0.5}) {
      FittedPath fitted;
      try {
        fitted = FitPath(given, {.max_deviation = allowed, .closed = run % 3 == 0});
      } catch (const InputError& error) {
        ASSERT_TRUE(run % 3 == 0) << error.what();
        EXPECT_THAT(error.what(), HasSubstr("from point 60 at"));
        continue;  // The last point is far from the first point.
      }
      if (run % 3 == 0 && !fitted.reversals.empty()) {
        continue;  // The path can close only by turning back.
      }
      ASSERT_TRUE(fitted.reversals.empty());
      EXPECT_LE(fitted.deviation, allowed);
      // The distance from a point to the nearest point of the path is at most the distance to the
      // path's point at the same station.
      EXPECT_LE(LargestDistance(fitted), fitted.deviation + Tolerance(1e-9));
      const Vec2 at = fitted.path.At(fitted.stations[fitted.deviation_point]).pose.position();
      EXPECT_NEAR((at - given.points[fitted.deviation_point]).norm(), fitted.deviation,
                  Tolerance(1e-12));
      for (std::size_t i = 1; i < fitted.stations.size(); ++i) {
        EXPECT_LT(fitted.stations[i - 1], fitted.stations[i]);
      }
    }
  }
}

TEST(FitPath, SmoothsNoiseWithinItsDeviation) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.03, 0.03);
  PathPoints given = Arc(30.0, 1.5, 200);
  for (Vec2& point : given.points) {
    point += Vec2(noise(random), noise(random));
  }
  const auto largest_curvature = [&](double allowed) {
    double largest = 0.0;
    for (const PathPoint& point : FitPath(given, {.max_deviation = allowed}).path.Sample(0.2)) {
      largest = std::max(largest, std::abs(point.curvature));
    }
    return largest;
  };
  // Noise of 0.03 m on points 0.23 m apart adds a curvature of about 0.03/0.23^2 = 0.6 1/m. If
  // max_deviation exceeds the noise, smoothing removes almost all of this curvature.
  EXPECT_GT(largest_curvature(0.001), 0.5);
  EXPECT_LT(largest_curvature(0.05), 0.05);
}

TEST(FitPath, PolylineLeadsThroughItsPoints) {
  PathPoints given;
  given.points = {{0.0, 0.0}, {10.0, 0.0}, {10.0, 5.0}, {10.0, 5.0}, {17.0, 12.0}};
  const FittedPath fitted = FitPath(given, {.fit = PathFit::kPolyline});
  ASSERT_EQ(fitted.jumps.size(), 2U);
  EXPECT_EQ(fitted.repeated, 1U);
  EXPECT_EQ(fitted.jumps[0].point, 1U);
  EXPECT_EQ(fitted.jumps[1].point, 2U);
  EXPECT_NEAR(fitted.jumps[0].angle, 0.5 * kPi, Tolerance(1e-12));
  EXPECT_NEAR(fitted.jumps[1].angle, -0.25 * kPi, Tolerance(1e-12));
  // FitPath replaces each corner by tangents of 1 mm and an arc of radius 1 mm/tan(angle/2). For
  // the angle of 90 degrees, the corner is 1 mm (sqrt(2) - 1) from the arc.
  EXPECT_NEAR(fitted.deviation, 1e-3 * (std::sqrt(2.0) - 1.0), Tolerance(1e-9));
  EXPECT_NEAR(fitted.path.At(fitted.path.length()).pose.x, 17.0, Tolerance(1e-9));
  EXPECT_NEAR(fitted.path.At(fitted.path.length()).pose.y, 12.0, Tolerance(1e-9));
  EXPECT_EQ(fitted.stations.size(), given.points.size());
  EXPECT_EQ(fitted.stations[2], fitted.stations[3]);
  EXPECT_NEAR(fitted.path.At(5.0).pose.y, 0.0, Tolerance(1e-12));
}

TEST(FitPath, ResamplesWithinItsDeviation) {
  const PathPoints given = Arc(20.0, 2.0, 2001);
  const FittedPath fitted =
      FitPath(given, {.max_deviation = 0.01, .closed = false, .resample = 0.5});
  EXPECT_LE(fitted.deviation, 0.01);
  EXPECT_LE(LargestDistance(fitted), 0.01);
  EXPECT_EQ(fitted.stations.size(), 2001U);
  const FittedPath lines = FitPath(given, {.fit = PathFit::kPolyline, .resample = 2.0});
  // The deviation is the height of an arc of radius 20 m over a chord of 2 m. The resampled points
  // need not include the ends of the arc.
  EXPECT_NEAR(lines.deviation, 2.0 * 2.0 / (8.0 * 20.0), Tolerance(2e-3));
  EXPECT_EQ(lines.jumps.size(), 19U);
}

// The given points are 5 m apart. A spline through the given points bulges near the corner. A
// spline through resampled points stays near the straight lines.
TEST(FitPath, KeepsToTheLinesIfResampled) {
  PathPoints given;
  given.points = {{0.0, 0.0}, {5.0, 0.0}, {10.0, 0.0}, {10.0, 5.0}, {10.0, 10.0}};
  const auto bulge = [&](const PathFitOptions& options) {
    double largest = 0.0;
    for (const PathPoint& point : FitPath(given, options).path.Sample(0.05)) {
      const Vec2 at = point.pose.position();
      const double first = std::hypot(at.y(), std::max(0.0, at.x() - 10.0));
      const double second = std::hypot(at.x() - 10.0, std::max(0.0, -at.y()));
      largest = std::max(largest, std::min(first, second));
    }
    return largest;
  };
  EXPECT_GT(bulge({.max_deviation = 0.05}), 0.3);
  // At the fitted points, the path is within 0.05 m of the lines. Between them, the distance may be
  // slightly larger.
  EXPECT_LE(bulge({.max_deviation = 0.05, .resample = 0.25}), 0.075);
}

TEST(FitPath, NamesThePointWhereAPathTurnsBack) {
  PathPoints given;
  given.points = {{0.0, 0.0}, {10.0, 0.0}, {12.5, 0.0}, {3.0, 0.1}};
  for (const PathFit fit : {PathFit::kPolyline, PathFit::kSpline}) {
    const FittedPath fitted = FitPath(given, {.fit = fit});
    ASSERT_EQ(fitted.reversals.size(), 1U);
    EXPECT_EQ(fitted.reversals[0].point, 2U);
    EXPECT_EQ(fitted.reversals[0].position, Vec2(12.5, 0.0));
    EXPECT_NEAR(fitted.reversals[0].s, 12.5, Tolerance(1e-12));
    EXPECT_EQ(fitted.path.length(), 0.0);
  }
}

TEST(FitPath, RefusesHeadingsAgainstTheDirectionOfMotion) {
  PathPoints given;
  given.points = {{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}};
  given.yaw = {0.1, 0.1, 0.1};
  EXPECT_NEAR(FitPath(given, {}).heading_difference, 0.1, Tolerance(1e-9));
  given.yaw = {kPi, kPi, kPi};
  given.direction = {1, 1, 1};
  try {
    FitPath(given, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the heading of point 1 at (0, 0)"));
  }
}

// The recorded point is the center of gravity, at the distance a ahead of the rear axle. If the
// center of gravity moves on a circle of radius R, the rear axle moves on a circle of radius
// sqrt(R^2 - a^2).
TEST(AtRearAxle, FollowsItsPointRoundACircle) {
  constexpr double kAhead = 1.4;
  for (const bool has_yaw : {false, true}) {
    PathPoints given = Arc(20.0, 3.0, 400);
    if (has_yaw) {
      for (std::size_t i = 0; i < given.points.size(); ++i) {
        given.yaw.push_back(3.0 * static_cast<double>(i) / 399.0 - std::asin(kAhead / 20.0));
      }
    }
    for (const Vec2& point : AtRearAxle(given, kAhead).points) {
      // Without given headings, the error is that of chords of 0.15 m, which deviate from the
      // circle by up to 0.15^2/160 = 1.4e-4 m. Over the distance of 1.4 m between both points, the
      // error is at most twice that.
      EXPECT_NEAR((point - Vec2(0.0, 20.0)).norm(), std::sqrt(400.0 - kAhead * kAhead),
                  Tolerance(has_yaw ? 1e-12 : 3e-4));
    }
  }
}

TEST(FitPath, RefusesWhatIsNoPath) {
  EXPECT_THROW(FitPath({}, {}), InputError);
  PathPoints one;
  one.points = {{1.0, 2.0}, {1.0, 2.0}};
  EXPECT_THROW(FitPath(one, {}), InputError);
  PathPoints two;
  two.points = {{1.0, 2.0}, {3.0, 2.0}};
  EXPECT_THROW(FitPath(two, {.closed = true}), InputError);
  EXPECT_NEAR(FitPath(two, {}).path.length(), 2.0, Tolerance(1e-12));
  EXPECT_THROW(FitPath(two, {.max_deviation = 0.0}), PreconditionError);
  two.speed = {1.0};
  EXPECT_THROW(FitPath(two, {}), PreconditionError);
  PathPoints broken;
  broken.points = {{0.0, 0.0}, {std::nan(""), 1.0}};
  EXPECT_THROW(FitPath(broken, {}), PreconditionError);
}

TEST(FitPath, TakesPointsCentimetersAndMetersApart) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-0.0005, 0.0005);
  PathPoints given;
  for (double x = 0.0; x < 100.0; x += x < 50.0 ? 7.0 : 0.02) {
    given.points.emplace_back(x, 3.0 * std::sin(0.05 * x) + noise(random));
  }
  const FittedPath fitted = FitPath(given, {.max_deviation = 0.005});
  EXPECT_LE(fitted.deviation, 0.005);
  for (const PathPoint& point : fitted.path.Sample(0.1)) {
    // The bound is twice the largest curvature of the curve, 3 x 0.05^2 1/m. Without smoothing,
    // noise of 0.5 mm on points 2 cm apart would cause a curvature of about 5 1/m.
    EXPECT_LE(std::abs(point.curvature), 2.0 * 3.0 * 0.05 * 0.05);
  }
}

}  // namespace
}  // namespace trackbed
