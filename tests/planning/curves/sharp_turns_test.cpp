#include "src/planning/curves/sharp_turns.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/planning/poses.h"
#include "tests/tolerance.h"

namespace trackbed {
namespace {

TEST(SharpTurns, TwoTurnsOfDifferentSharpnessJoinStates) {
  Random random(1);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const double radius = random.Uniform(1.0, 8.0);
    const double first = std::exp(random.Uniform(-1.0, 4.0)) / (radius * radius);
    const double last = std::exp(random.Uniform(-1.0, 4.0)) / (radius * radius);
    const double most = 1.0 / radius;
    const CurveState from{RandomPose(random, 20.0), random.Uniform(-most, most)};
    const CurveState to{RandomPose(random, 20.0), random.Uniform(-most, most)};
    const ShortestCurve curve = TwoTurns(radius, first, last, from, to);
    if (!std::isfinite(curve.length)) {
      continue;
    }
    ++found;
    const Path path(from.pose, ToSegments(curve));
    ASSERT_LE(Apart(path.At(path.length()).pose, to.pose), Tolerance(1e-9));
    // Rounding of sums of up to 1e3 r.
    ASSERT_NEAR(path.length(), curve.length, Tolerance(1e-10));
    const double rounding = Tolerance(1e-12);
    double curvature = from.curvature;
    for (const Segment& segment : path.segments()) {
      ASSERT_NEAR(segment.curvature * radius, curvature * radius, rounding);
      curvature = segment.CurvatureAt(segment.length);
      ASSERT_LE(std::abs(curvature) * radius, 1.0 + rounding);
      ASSERT_LE(std::abs(segment.sharpness), std::max(first, last) * (1.0 + rounding));
    }
    ASSERT_NEAR(curvature * radius, to.curvature * radius, rounding);
    ASSERT_GT(std::abs(path.segments().front().sharpness), 0.0);
    ASSERT_NEAR(std::abs(path.segments().front().sharpness) / first, 1.0, rounding);
    ASSERT_NEAR(std::abs(path.segments().back().sharpness) / last, 1.0, rounding);
  }
  // Most of these distant states are joined by turns that do not make a loop.
  EXPECT_GT(found, 1000);
}

TEST(SharpTurns, TwoTurnsAreNotShorterThanTheShortestCurveOfTheSharperTurn) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const CurveState from{RandomPose(random, 20.0)};
    const CurveState to{RandomPose(random, 20.0)};
    const ContinuousCurves curves({3.0, 0.2});
    const double shortest = curves.Dubins(from, to).length;
    EXPECT_GE(TwoTurns(3.0, 0.2, 0.1, from, to).length, shortest - Tolerance(1e-10));
    EXPECT_GE(TwoTurns(3.0, 0.1, 0.2, from, to).length, shortest - Tolerance(1e-10));
    // With one sharpness, they are words of these curves.
    EXPECT_GE(TwoTurns(3.0, 0.2, 0.2, from, to).length, shortest - Tolerance(1e-10));
  }
}

TEST(SharpTurns, TwoTurnsKeepTheirLengthBelowTheLimit) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const double most = 1.0 / 3.0;
    const CurveState from{RandomPose(random, 20.0), random.Uniform(-most, most)};
    const CurveState to{RandomPose(random, 20.0), random.Uniform(-most, most)};
    const double shortest = TwoTurns(3.0, 0.2, 0.1, from, to).length;
    if (std::isfinite(shortest)) {
      EXPECT_EQ(TwoTurns(3.0, 0.2, 0.1, from, to, shortest * (1.0 + 1e-9)).length, shortest) << i;
      EXPECT_EQ(TwoTurns(3.0, 0.2, 0.1, from, to, shortest * (1.0 - 1e-9)).length, kNoCurve) << i;
    }
  }
}

}  // namespace
}  // namespace trackbed
