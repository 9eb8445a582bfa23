#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/path/fit_path.h"

// Tests the bound of FitPathWithin on the curvature.
namespace trackbed {
namespace {

/// Points on a line, an arc that turns by `turn` [rad], and a second line, recorded at intervals of
/// `spacing` [m] with noise.
PathPoints Turn(double radius, double turn, double spacing, double noise, unsigned seed) {
  const double side = std::copysign(1.0, turn);
  const Path path({0.0, 0.0, 0.3},
                  {{.length = 20.0, .curvature = 0.0, .direction = 1},
                   {.length = radius * std::abs(turn), .curvature = side / radius, .direction = 1},
                   {.length = 20.0, .curvature = 0.0, .direction = 1}});
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0.0, noise > 0.0 ? noise : 1.0);
  PathPoints given;
  for (double s = 0.0; s <= path.length(); s += spacing) {
    Vec2 point = path.At(s).pose.position();
    if (noise > 0.0) {
      point += Vec2(error(random), error(random));
    }
    given.points.push_back(point);
  }
  return given;
}

double LargestCurvature(const Path& path) {
  double largest = 0.0;
  for (double s = 0.0; s <= path.length(); s += 0.01) {
    largest = std::max(largest, std::abs(path.At(s).curvature));
  }
  return largest;
}

TEST(FitPathWithin, KeepsTheCurvatureOfAnArcBetweenLines) {
  std::mt19937 random(7);
  const auto between = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  int exceeded = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const double radius = between(3.0, 12.0);
    const double turn = (seed % 2 == 0 ? 1.0 : -1.0) * between(0.8, 3.0);
    // Noise of a tenth of the largest deviation, in every second path.
    const double noise = seed % 4 < 2 ? 0.0 : 0.005;
    const PathPoints given = Turn(radius, turn, between(0.2, 0.8), noise, seed);
    const PathFitOptions options{.max_deviation = 0.05};
    const double bound = 1.005 / radius;
    const FittedPath free = FitPath(given, options);
    const FittedPath bounded = FitPathWithin(given, options, bound);
    exceeded += LargestCurvature(free.path) > 1.01 * bound ? 1 : 0;
    // FitPathWithin promises to exceed the bound of the curvature by at most the fraction 1e-3.
    EXPECT_LE(LargestCurvature(bounded.path), (1.0 + Tolerance(1e-3)) * bound)
        << "radius " << radius << ", turn " << turn << ", noise " << noise;
    EXPECT_LE(bounded.deviation, options.max_deviation + Tolerance(1e-9));
  }
  // Without the bound, the curvature must exceed that of the arc, or the test would check nothing.
  EXPECT_GE(exceeded, 15);
}

TEST(FitPathWithin, ChangesNothingBelowTheBound) {
  const PathPoints given = Turn(8.0, 1.5, 0.5, 0.005, 3);
  const FittedPath free = FitPath(given, {});
  const FittedPath bounded = FitPathWithin(given, {}, 1.01 * LargestCurvature(free.path));
  // Newton's method ends at the same curve, up to rounding, from every start.
  EXPECT_NEAR(bounded.path.length(), free.path.length(), Tolerance(1e-6));
  for (double s = 0.0; s <= free.path.length(); s += 0.5) {
    const Vec2 apart = bounded.path.At(s).pose.position() - free.path.At(s).pose.position();
    EXPECT_LE(apart.norm(), Tolerance(1e-6)) << s;
  }
  EXPECT_THROW(FitPathWithin(given, {}, 0.0), PreconditionError);
}

}  // namespace
}  // namespace trackbed
