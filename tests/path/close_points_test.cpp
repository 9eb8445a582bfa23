#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/path/fit_path.h"

// Fits of points that are much closer to each other than most.
namespace trackbed {
namespace close_points_test {

/// Curvatures over a share of the length [1/m]; the headings follow by numerical integration.
struct CurveShape {
  const char* name;
  double (*curvature)(double share);
};

double Straight(double /*share*/) {
  return 0.0;
}

double Bend(double /*share*/) {
  return 1.0 / 12.0;
}

double Spiral(double share) {
  return share / 8.0;
}

double Wave(double share) {
  return 0.1 * std::sin(2.0 * 3.14159265358979323846 * share);
}

/// Returns points every `spacing` [m] along 30 m of a shape, exact to about 1e-6 m.
std::vector<Vec2> PointsAlong(const CurveShape& shape, double spacing) {
  constexpr double kLength = 30.0;
  constexpr int kSteps = 20;
  std::vector<Vec2> points{{0.0, 0.0}};
  const int count = static_cast<int>(std::lround(kLength / spacing));
  double yaw = 0.0;
  for (int i = 0; i < count; ++i) {
    Vec2 at = points.back();
    for (int k = 0; k < kSteps; ++k) {
      const double step = spacing / kSteps;
      const double turn = step * shape.curvature((i + (k + 0.5) / kSteps) / count);
      at += step * Vec2(std::cos(yaw + 0.5 * turn), std::sin(yaw + 0.5 * turn));
      yaw += turn;
    }
    points.push_back(at);
  }
  return points;
}

class ClosePoints : public ::testing::TestWithParam<CurveShape> {};

// Five more points after every 25th point, at a random distance from 0.01 to 2 mm from each other,
// on the straight line to the next point.
TEST_P(ClosePoints, AreFittedAsThePathWithoutThem) {
  const std::vector<Vec2> points = PointsAlong(GetParam(), 0.2);
  Random random(47);
  PathPoints given;
  PathPoints sparse;
  sparse.points = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    given.points.push_back(points[i]);
    if (i % 25 == 0 && i + 1 < points.size()) {
      const double apart = std::pow(10.0, random.Uniform(-5.0, -2.7));
      const Vec2 ahead = (points[i + 1] - points[i]).normalized();
      for (int k = 1; k <= 5; ++k) {
        given.points.push_back(points[i] + k * apart * ahead);
      }
    }
  }
  const PathFitOptions options;
  const FittedPath fitted = FitPath(given, options);
  const FittedPath plain = FitPath(sparse, options);
  EXPECT_LE(fitted.deviation, options.max_deviation);
  // Both paths are within max_deviation of the points, of which the ends are exact.
  EXPECT_NEAR(fitted.path.length(), plain.path.length(), Tolerance(2.0 * options.max_deviation));
  EXPECT_EQ(fitted.stations.size(), given.points.size());
  EXPECT_TRUE(std::is_sorted(fitted.stations.begin(), fitted.stations.end()));
}

// 200 001 points are more than a spline may have, but most of them are closer than the fit
// resolves.
TEST(ClosePoints, MayBeMoreThanASplineCanHave) {
  PathPoints given;
  for (int i = 0; i <= 200000; ++i) {
    given.points.emplace_back(1e-5 * i, 0.0);
  }
  const FittedPath fitted = FitPath(given, {});
  EXPECT_NEAR(fitted.path.length(), 2.0, Tolerance(1e-9));
}

// A recorder logs a car that stands at the begin, at 10 m and at the end of a line, with noise of
// the positions of up to 17 mm along each axis: at most 48 mm between two points, less than the
// largest deviation of 50 mm.
TEST(ClosePoints, AreOnePlaceWhereTheSpeedIsZero) {
  Random random(471);
  PathPoints given;
  const auto add = [&](double s, double speed, double noise) {
    given.points.emplace_back(s + random.Uniform(-noise, noise), random.Uniform(-noise, noise));
    given.speed.push_back(speed);
  };
  const auto stand = [&](double s) {
    for (int i = 0; i < 40; ++i) {
      add(s, 0.0, 0.017);
    }
  };
  stand(0.0);
  for (double s = 0.5; s < 20.0; s += 0.5) {
    s == 10.0 ? stand(s) : add(s, 2.0, 0.0);
  }
  stand(20.0);
  const PathFitOptions options;
  const FittedPath fitted = FitPath(given, options);
  EXPECT_NEAR(fitted.path.length(), 20.0, Tolerance(2.0 * options.max_deviation));
  for (std::size_t i = 1; i < given.speed.size(); ++i) {
    if (given.speed[i] == 0.0 && given.speed[i - 1] == 0.0) {
      EXPECT_EQ(fitted.stations[i], fitted.stations[i - 1]) << i;
    }
  }
}

// A file without some of its speeds: the points move by 0.5 m each, so the car does not stand.
TEST(ClosePoints, StayApartWhereTheCarMovesWithTheSpeedZero) {
  PathPoints given;
  for (int i = 0; i <= 40; ++i) {
    given.points.emplace_back(0.5 * i, 0.0);
    given.speed.push_back(i < 10 || i > 20 ? 2.0 : 0.0);
  }
  const FittedPath fitted = FitPath(given, {});
  for (std::size_t i = 0; i < given.points.size(); ++i) {
    EXPECT_NEAR(fitted.stations[i], 0.5 * static_cast<double>(i), Tolerance(1e-9));
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, ClosePoints,
                         ::testing::Values(CurveShape{"Straight", Straight},
                                           CurveShape{"Bend", Bend}, CurveShape{"Spiral", Spiral},
                                           CurveShape{"Wave", Wave}),
                         [](const auto& shape) { return std::string(shape.param.name); });

}  // namespace close_points_test
}  // namespace trackbed
