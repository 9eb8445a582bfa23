#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/error_text.h"
#include "trackbed/core/angle.h"
#include "trackbed/path/fit_path.h"

namespace trackbed {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string ErrorOf(const PathPoints& given, const PathFitOptions& options = {}) {
  return ErrorText([&] { static_cast<void>(FitPath(given, options)); });
}

double PolylineLength(const std::vector<Vec2>& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    length += (points[i] - points[i - 1]).norm();
  }
  return length;
}

double DistanceToPolyline(const Vec2& p, const std::vector<Vec2>& points) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec2 along = points[i] - points[i - 1];
    const double share = std::clamp(along.dot(p - points[i - 1]) / along.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (points[i - 1] + share * along - p).norm());
  }
  return nearest;
}

double LargestBulge(const FittedPath& fitted) {
  double largest = 0.0;
  for (const PathPoint& point : fitted.path.Sample(0.5)) {
    largest = std::max(largest, DistanceToPolyline(point.pose.position(), fitted.given.points));
  }
  return largest;
}

/// Returns seven points of a winding path, 10 m apart along x.
PathPoints SevenPoints() {
  PathPoints given;
  for (int i = 0; i < 7; ++i) {
    given.points.emplace_back(10.0 * i, 3.0 * std::sin(0.7 * i));
  }
  return given;
}

TEST(PathWithAnOutlier, IsRefusedOrStaysNearItsPoints) {
  for (std::size_t i = 0; i < 7; ++i) {
    for (int direction = 0; direction < 8; ++direction) {
      SCOPED_TRACE(std::to_string(i) + " moved to " + std::to_string(direction));
      PathPoints given = SevenPoints();
      const double angle = 0.1 + 0.25 * kPi * direction;
      given.points[i] += 1000.0 * Vec2(std::cos(angle), std::sin(angle));
      if (!ErrorOf(given).empty()) {
        continue;
      }
      const FittedPath fitted = FitPath(given, {});
      if (!fitted.reversals.empty()) {
        continue;
      }
      // Between two points, the path may turn by up to half a circle, which is pi/2 times as long
      // as its chord.
      EXPECT_LE(fitted.path.length(), 0.5 * kPi * PolylineLength(given.points) + 1.0);
      // FitPath measures a bulge at sixteen points, which miss the top of the bulge. For a bulge of
      // a fifth of the chord, the measured height is up to a hundredth too small. LargestBulge
      // measures the distance to the nearest line, which may be less than the distance to the
      // chord.
      EXPECT_GE(fitted.bulge, 0.97 * LargestBulge(fitted) - 0.05);
    }
  }
}

TEST(PathWithAnOutlier, NamesThePoint) {
  PathPoints given = SevenPoints();
  given.points[0] += Vec2(740.0, 740.0);
  EXPECT_THAT(ErrorOf(given), AllOf(HasSubstr("the spline swings up to "),
                                    HasSubstr("Is point 1 at (740, 740) wrong?"),
                                    HasSubstr("resample the points every 0.15 m")));
  for (int line = 2; line < 9; ++line) {
    given.lines.push_back(line);
  }
  EXPECT_THAT(ErrorOf(given), HasSubstr("Is row 2 at (740, 740) wrong?"));
  // The message names two remedies. Both must succeed.
  EXPECT_EQ(ErrorOf(given, {.fit = PathFit::kPolyline}), "");
  EXPECT_EQ(ErrorOf(given, {.resample = 0.15}), "");
}

/// Returns points of a stadium: 15 m apart on half circles of radius 50 m, none on its straights.
PathPoints StadiumWithoutStraights(double straight) {
  constexpr double kRadius = 50.0;
  constexpr int kSteps = 10;
  PathPoints given;
  for (const double side : {1.0, -1.0}) {
    for (int i = 0; i <= kSteps; ++i) {
      const double angle = kPi * (static_cast<double>(i) / kSteps - 0.5);
      given.points.push_back(
          side * Vec2(0.5 * straight + kRadius * std::cos(angle), kRadius * std::sin(angle)));
    }
  }
  return given;
}

// A smooth curve leaves each chord of 15.7 m by at most its height on the circle, 15.7^2/(8 x 50 m)
// = 0.62 m, on either side, and the deviation of 0.05 m. On a straight, the first added point is as
// far from its end as the points of the bend are apart, so the bound is the same. Without added
// points, the spline swings 58 m aside of a straight of 400 m.
TEST(PathWithSparsePoints, KeepsToLongStraights) {
  for (const double straight : {100.0, 400.0, 3000.0}) {
    SCOPED_TRACE(straight);
    const PathPoints given = StadiumWithoutStraights(straight);
    for (const bool closed : {false, true}) {
      const FittedPath fitted = FitPath(given, {.closed = closed});
      EXPECT_GT(fitted.added, 0U);
      for (const PathPoint& point : fitted.path.Sample(0.5)) {
        const Vec2& at = point.pose.position();
        const double past = std::max(0.0, std::abs(at.x()) - 0.5 * straight);
        EXPECT_NEAR(std::hypot(past, at.y()), 50.0, 0.62 + 0.05);
      }
    }
  }
}

// A gap in a bend is no straight: the curve continues the circle. It leaves the circle by less than
// half of the height of the arc over the gap, 50 m (1 - cos(0.5 x 8 x 0.1)) = 3.9 m.
TEST(PathWithSparsePoints, ContinuesABendInAGap) {
  PathPoints given;
  for (int i = 0; i < 40; ++i) {
    if (i < 16 || i > 22) {
      given.points.emplace_back(50.0 * std::cos(0.1 * i), 50.0 * std::sin(0.1 * i));
    }
  }
  const FittedPath fitted = FitPath(given, {});
  EXPECT_EQ(fitted.added, 0U);
  for (const PathPoint& point : fitted.path.Sample(0.5)) {
    EXPECT_NEAR(point.pose.position().norm(), 50.0, 0.5 * 50.0 * (1.0 - std::cos(0.4)));
  }
}

TEST(PathWithSparsePoints, HasItsBulge) {
  // A circle through the corners of a square bulges beyond each side by (sqrt(2) - 1)/2 of the
  // side. The closed spline is close to this circle.
  PathPoints square;
  square.points = {{0.0, 0.0}, {40.0, 0.0}, {40.0, 40.0}, {0.0, 40.0}};
  const FittedPath fitted = FitPath(square, {.closed = true});
  EXPECT_NEAR(fitted.bulge, 20.0 * (std::sqrt(2.0) - 1.0), 0.5);
  EXPECT_EQ(FitPath(square, {.fit = PathFit::kPolyline}).bulge, 0.0);
}

TEST(PathOfTheLargestLength, IsFittedWithinItsBound) {
  PathPoints given;
  for (int i = 0; i <= 2000; ++i) {
    const double x = 99.0 * i;
    given.points.emplace_back(x, 300.0 * std::sin(x / 3000.0));
  }
  const FittedPath fitted = FitPath(given, {});
  EXPECT_GT(fitted.path.length(), 198e3);
  EXPECT_LE(fitted.path.segments().size(), 1'100'000U);
  given.points.emplace_back(299e3, 0.0);
  EXPECT_THAT(ErrorOf(given), HasSubstr("must be at most 200000 m: the gap between points 2001 and "
                                        "2002 is "));
}

}  // namespace
}  // namespace trackbed
