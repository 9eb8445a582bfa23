#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/path/fit_path.h"

// Tests that a spline fitted to points of a line, an arc or a clothoid equals that curve. Tests
// that a fitted path begins and ends at its first and last point, and that measurement noise is not
// taken for a change of direction.
namespace trackbed {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double Between(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  double Normal(double deviation) {
    return std::normal_distribution<double>(0.0, deviation)(random_);
  }
  /// Returns a number whose logarithm is uniform.
  double Magnitude(double from, double to) {
    return std::exp(Between(std::log(from), std::log(to)));
  }

 private:
  std::mt19937 random_;
};

PathPoints PointsOf(const Path& path, int count, double unevenness, Dice& dice) {
  PathPoints given;
  for (int i = 0; i < count; ++i) {
    const double own = i > 0 && i + 1 < count ? unevenness * dice.Between(-0.4, 0.4) : 0.0;
    given.points.push_back(path.At(path.length() * (i + own) / (count - 1)).pose.position());
  }
  return given;
}

/// Returns a random line (kind 0), arc (kind 1) or clothoid (kind 2) that turns by less than a full
/// turn.
Segment Primitive(int kind, Dice& dice) {
  const double curvature = dice.Magnitude(1e-3, 0.2);
  Segment segment{.length = std::min(dice.Between(5.0, 100.0), 6.0 / curvature)};
  if (kind == 1) {
    segment.curvature = dice.Between(0.0, 1.0) < 0.5 ? curvature : -curvature;
  } else if (kind == 2) {
    segment.curvature = dice.Between(-curvature, curvature);
    const double end = dice.Between(-curvature, curvature);
    segment.sharpness = (end - segment.curvature) / segment.length;
  }
  return segment;
}

/// Returns the rounding error of a path at coordinates of `offset` [m]. The path has up to 1000
/// segments of 0.1 m, and each segment adds the rounding errors of two coordinates. The sum of
/// these errors grows with the square root of the number of segments, as in a random walk.
double Rounding(double offset) {
  return 10.0 * std::sqrt(1000.0) * 2.3e-16 * offset;
}

TEST(FitPath, IsExactOnLinesArcsAndClothoids) {
  Dice dice(47);
  for (int run = 0; run < 150; ++run) {
    SCOPED_TRACE(run);
    const double offset = dice.Magnitude(1.0, 1e6);
    const Path path({offset * dice.Between(-1.0, 1.0), offset * dice.Between(-1.0, 1.0),
                     dice.Between(-kPi, kPi)},
                    {Primitive(run % 3, dice)});
    const auto count = static_cast<int>(dice.Magnitude(10.0, run % 10 == 0 ? 1000.0 : 200.0));
    const double deviation = dice.Magnitude(1e-6, 1.0);
    const PathPoints given = PointsOf(path, count, run % 4 == 0 ? 1.0 : 0.0, dice);
    const FittedPath fitted = FitPath(given, {.max_deviation = deviation});
    const double tolerance = Tolerance(1e-9 + Rounding(offset));
    EXPECT_NEAR(fitted.path.length(), path.length(), tolerance);
    for (double share = 0.0; share <= 1.0; share += 0.02) {
      const Pose2 own = fitted.path.At(share * fitted.path.length()).pose;
      const Pose2 exact = path.At(share * path.length()).pose;
      ASSERT_LE((own.position() - exact.position()).norm(), tolerance) << share;
      // The error of a heading is the position error divided by the distance between the points,
      // which is at least 5 mm.
      ASSERT_NEAR(AngleDifference(own.yaw, exact.yaw), 0.0, tolerance / 5e-3) << share;
    }
  }
}

// These straight lines come from issue reports: 51 and 501 points on 50 m.
TEST(FitPath, IsExactOnALongStraight) {
  for (const int count : {51, 501}) {
    for (const double deviation : {1e-6, 0.05, 0.5, 10.0}) {
      PathPoints given;
      for (int i = 0; i < count; ++i) {
        given.points.emplace_back(50.0 * i / (count - 1), 0.0);
      }
      const FittedPath fitted = FitPath(given, {.max_deviation = deviation});
      EXPECT_NEAR(fitted.path.length(), 50.0, Tolerance(1e-9));
      EXPECT_NEAR(fitted.path.At(fitted.path.length()).pose.x, 50.0, Tolerance(1e-9));
      EXPECT_NEAR(fitted.path.At(25.0).pose.y, 0.0, Tolerance(1e-9));
    }
  }
}

TEST(FitPath, KeepsTheEndsOfARoad) {
  Dice dice(48);
  for (int run = 0; run < 40; ++run) {
    SCOPED_TRACE(run);
    const double spiral = dice.Between(2.0, 20.0);
    const double curvature = dice.Between(-0.2, 0.2);
    const Path road({dice.Between(-1e3, 1e3), dice.Between(-1e3, 1e3), dice.Between(-kPi, kPi)},
                    {{.length = dice.Between(2.0, 20.0)},
                     {.length = spiral, .sharpness = curvature / spiral},
                     {.length = dice.Between(2.0, 20.0), .curvature = curvature},
                     {.length = spiral, .curvature = curvature, .sharpness = -curvature / spiral},
                     {.length = dice.Between(2.0, 20.0)}});
    const double deviation = dice.Magnitude(1e-3, 0.5);
    PathPoints given = PointsOf(road, static_cast<int>(dice.Magnitude(20.0, 300.0)), 1.0, dice);
    const double noise = run % 2 == 0 ? 0.0 : 0.2 * deviation;
    for (Vec2& point : given.points) {
      point += Vec2(dice.Normal(noise), dice.Normal(noise));
    }
    const FittedPath fitted = FitPath(given, {.max_deviation = deviation});
    if (!fitted.reversals.empty()) {
      continue;  // The noise is as large as the distance between the points.
    }
    EXPECT_LE(fitted.deviation, deviation);
    const Vec2 begin = fitted.path.At(0.0).pose.position();
    const Vec2 end = fitted.path.At(fitted.path.length()).pose.position();
    EXPECT_LE((begin - given.points.front()).norm(), Tolerance(1e-9));
    EXPECT_LE((end - given.points.back()).norm(), Tolerance(1e-9));
  }
}

TEST(FitPath, KeepsTheEndsOfRandomPoints) {
  Dice dice(49);
  int fits = 0;
  for (int run = 0; run < 40; ++run) {
    SCOPED_TRACE(run);
    const double noise = dice.Magnitude(1e-3, 0.1);
    const double turn = dice.Between(0.01, 1.2);
    const double step = dice.Magnitude(0.01, 10.0);
    PathPoints given;
    Pose2 pose;
    for (int i = 0; i < 80; ++i) {
      given.points.push_back(pose.position() + Vec2(dice.Normal(noise), dice.Normal(noise)));
      pose.yaw += dice.Between(-turn, turn);
      const Vec2 move = step * dice.Between(0.1, 2.0) * Direction(pose.yaw);
      pose = {pose.x + move.x(), pose.y + move.y(), pose.yaw};
    }
    try {
      const FittedPath fitted = FitPath(given, {.max_deviation = dice.Magnitude(3e-3, 1.0)});
      if (!fitted.reversals.empty()) {
        continue;
      }
      ++fits;
      EXPECT_LE(fitted.deviation, fitted.options.max_deviation);
      const Vec2 begin = fitted.path.At(0.0).pose.position();
      const Vec2 end = fitted.path.At(fitted.path.length()).pose.position();
      EXPECT_LE((begin - given.points.front()).norm(), Tolerance(1e-9));
      EXPECT_LE((end - given.points.back()).norm(), Tolerance(1e-9));
    } catch (const InputError&) {
      continue;  // No spline stays within max_deviation of the points.
    }
  }
  EXPECT_GE(fits, 15);
}

/// Returns the recorded positions of a car that drives along a circle of radius 20 m and stops
/// twice. The points of the path have random errors with the standard deviation `noise` [m].
/// Neighboring points are up to `step` [m] apart.
PathPoints Recording(double noise, Dice& dice, double step = 0.1) {
  PathPoints given;
  double s = 0.0;
  for (int i = 0; i < 600; ++i) {
    const double phase = (i % 200) / 200.0;
    s += phase < 0.3 ? 0.0 : step * std::sin(kPi * (phase - 0.3) / 0.7);
    given.points.push_back(Vec2(20.0 * std::sin(s / 20.0), 20.0 * (1.0 - std::cos(s / 20.0))) +
                           Vec2(dice.Normal(noise), dice.Normal(noise)));
  }
  return given;
}

TEST(FitPath, TakesTheJitterOfARecorder) {
  Dice dice(50);
  for (int run = 0; run < 10; ++run) {
    SCOPED_TRACE(run);
    const PathPoints given = Recording(0.005, dice);
    for (const auto& resample : {std::optional<double>(), std::optional<double>(0.5)}) {
      const FittedPath fitted = FitPath(given, {.max_deviation = 0.06, .resample = resample});
      ASSERT_TRUE(fitted.reversals.empty());
      EXPECT_GT(fitted.merged, 0U);
      EXPECT_LE(fitted.deviation, 0.06);
      EXPECT_TRUE(std::is_sorted(fitted.stations.begin(), fitted.stations.end()));
      // The car drives 26.7 m. The noise moves the ends of the path by a few standard deviations.
      EXPECT_NEAR(fitted.path.length(), 26.7, Tolerance(0.1));
      for (const PathPoint& point : fitted.path.Sample(0.1)) {
        // The circle's curvature is 0.05 1/m.
        EXPECT_LE(std::abs(point.curvature), 0.3) << point.s;
      }
    }
  }
}

// If no spline can stay within max_deviation of the noisy points, the message must name a
// sufficient max_deviation.
TEST(FitPath, SaysHowMuchDeviationTheNoiseNeeds) {
  Dice dice(52);
  int messages = 0;
  for (int run = 0; run < 30; ++run) {
    const PathPoints given = Recording(0.005, dice, dice.Between(0.01, 0.25));
    try {
      static_cast<void>(
          FitPath(given, {.max_deviation = dice.Between(0.015, 0.03), .resample = 0.5}));
    } catch (const InputError& error) {
      const std::string text = error.what();
      const std::size_t value = text.find("use at least ");
      ASSERT_NE(value, std::string::npos) << text;
      const double allowed = std::stod(text.substr(value + 13));
      const FittedPath fitted = FitPath(given, {.max_deviation = allowed, .resample = 0.5});
      EXPECT_TRUE(fitted.reversals.empty());
      ++messages;
    }
  }
  EXPECT_GE(messages, 3);
}

// The spline follows points at every meter, and misses the points between them by the noise.
TEST(FitPath, SaysHowMuchDeviationTheSplineNeeds) {
  Dice dice(53);
  int messages = 0;
  for (int run = 0; run < 10; ++run) {
    PathPoints given;
    for (double s = 0.0; s < 30.0; s += 0.5) {
      given.points.push_back(Vec2(20.0 * std::sin(s / 20.0), 20.0 * (1.0 - std::cos(s / 20.0))) +
                             Vec2(dice.Normal(0.02), dice.Normal(0.02)));
    }
    const double wanted = dice.Between(0.03, 0.05);
    try {
      static_cast<void>(FitPath(given, {.max_deviation = wanted, .resample = 1.0}));
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_THAT(text, ::testing::HasSubstr(fmt::format("{:.3g} m cannot be kept", wanted)));
      const std::size_t value = text.find("use at least ");
      ASSERT_NE(value, std::string::npos) << text;
      const double allowed = std::stod(text.substr(value + 13));
      EXPECT_GT(allowed, wanted);
      EXPECT_LE(FitPath(given, {.max_deviation = allowed, .resample = 1.0}).deviation, allowed);
      ++messages;
    }
  }
  EXPECT_GE(messages, 3);
}

TEST(FitPath, NamesTheDeviationThatTakesTheNoise) {
  Dice dice(51);
  const PathPoints given = Recording(0.005, dice);
  const FittedPath refused = FitPath(given, {.max_deviation = 0.005});
  ASSERT_FALSE(refused.reversals.empty());
  ASSERT_TRUE(refused.noise_deviation.has_value());
  EXPECT_LE(*refused.noise_deviation, 0.06);
  EXPECT_TRUE(FitPath(given, {.max_deviation = *refused.noise_deviation}).reversals.empty());
}

}  // namespace
}  // namespace trackbed
