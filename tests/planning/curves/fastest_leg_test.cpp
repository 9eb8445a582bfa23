#include "src/planning/curves/fastest_leg.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/planning/poses.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/curves/continuous_curvature.h"

// Legs that are driven in little time, from words at the speed of the mission.
namespace trackbed {
namespace {

constexpr double kRadius = 5.61;
constexpr LegLimits kPriusLimits{.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5},
                                 .steering_rate = 0.135,
                                 .lateral = 3.0,
                                 .wheelbase = 2.7};

double TimeOf(const std::vector<Segment>& segments, double start, double end) {
  return LegTime(kPriusLimits, LegPieces(kPriusLimits, segments, 0.0, 1), start, end);
}

/// Divides segments into `each` parts; the speeds are those of a word at the mission's speed.
FastestLeg LegFrom(const std::vector<Segment>& segments, double start, double end, int each) {
  FastestLeg leg{.start = segments,
                 .speeds = {start},
                 .curvature = 1.0 / kRadius,
                 .min_speed = 0.3,
                 .limits = kPriusLimits};
  for (const Segment& segment : segments) {
    for (int i = 0; i < each; ++i) {
      leg.lengths.push_back(segment.length / each);
      leg.speeds.push_back(kPriusLimits.speed.speed);
    }
  }
  leg.speeds.back() = end;
  return leg;
}

std::vector<Segment> WordTo(const Pose2& goal) {
  const double sharpness = kPriusLimits.steering_rate / (2.7 * 3.0);
  return ToSegments(ContinuousCurves({kRadius, sharpness}).Dubins({}, {goal}));
}

TEST(FastestLeg, MeetsTheGoalWithinTheLimitsInLessTime) {
  Random random(1);
  double ratios = 0.0;
  constexpr int kLegs = 12;
  for (int i = 0; i < kLegs; ++i) {
    const Pose2 goal = RandomPose(random, 25.0);
    const std::vector<Segment> word = WordTo(goal);
    const auto found = FasterLegs().Find(LegFrom(word, 0.0, 0.0, 2));
    ASSERT_TRUE(found);
    const Path path({}, *found);
    EXPECT_LE(Apart(path.At(path.length()).pose, goal), Tolerance(1e-10));
    double curvature = 0.0;
    for (const Segment& segment : *found) {
      EXPECT_NEAR(segment.curvature, curvature, Tolerance(1e-12));
      curvature = segment.CurvatureAt(segment.length);
      EXPECT_LE(std::abs(curvature), (1.0 + Tolerance(1e-12)) / kRadius);
    }
    EXPECT_NEAR(curvature, 0.0, Tolerance(1e-12));
    ratios += TimeOf(*found, 0.0, 0.0) / TimeOf(word, 0.0, 0.0);
  }
  // scripts/time_optimum finds about 0.88 for such legs; half of this gain must remain.
  EXPECT_LE(ratios / kLegs, 0.94);
}

/// Returns the least time in which the car can change its heading by an angle, with straight wheels
/// before and after. At the speed v, wheels that turn to omega T/2 and back change it by
/// -2 v/(L omega) ln cos(omega T/2).
double LeastTimeToTurn(double angle) {
  const LegLimits& limits = kPriusLimits;
  const double exponent =
      -0.5 * std::abs(angle) * limits.wheelbase * limits.steering_rate / limits.speed.speed;
  return 2.0 / limits.steering_rate * std::acos(std::exp(exponent));
}

// A ramp of the curvature and its reverse, without an arc between them, takes at most 1.6 % longer
// than the least time. The chord of the turn takes up to 17 % less time.
TEST(FastestLeg, IsNotFasterThanTheWheelsTurn) {
  const double v = kPriusLimits.speed.speed;
  const double sharpness = kPriusLimits.steering_rate / (kPriusLimits.wheelbase * v);
  for (const double angle : {0.4, 0.8, 1.2, 1.6}) {
    SCOPED_TRACE(angle);
    const double ramp = std::sqrt(angle / sharpness);
    const std::vector<Segment> turn{
        {.length = ramp, .sharpness = sharpness},
        {.length = ramp, .curvature = sharpness * ramp, .sharpness = -sharpness}};
    const auto found = FasterLegs().Find(LegFrom(turn, v, v, 3));
    ASSERT_TRUE(found);
    const double time = TimeOf(*found, v, v);
    EXPECT_GE(time, LeastTimeToTurn(angle) * (1.0 - Tolerance(1e-9)));
    // The speed on a part is that for its smallest curvature: 1 + (L kappa)^2 changes by at most
    // 0.23 over the 16 parts of a piece.
    EXPECT_LE(time, TimeOf(turn, v, v) * (1.0 + 0.23 / 16.0));
  }
}

TEST(FastestLeg, MirrorsALegInReverse) {
  const std::vector<Segment> word = WordTo({12.0, 9.0, 2.0});
  std::vector<Segment> back = word;
  for (Segment& segment : back) {
    segment.direction = -1;
  }
  const auto ahead = FasterLegs().Find(LegFrom(word, 0.0, 0.0, 2));
  const auto behind = FasterLegs().Find(LegFrom(back, 0.0, 0.0, 2));
  ASSERT_TRUE(ahead && behind);
  ASSERT_EQ(ahead->size(), behind->size());
  for (std::size_t i = 0; i < ahead->size(); ++i) {
    // The programs are equal except for the rounding of the goal, which the search amplifies.
    EXPECT_NEAR((*ahead)[i].length, (*behind)[i].length, Tolerance(1e-5));
    EXPECT_EQ((*behind)[i].direction, -1);
  }
}

bool SameSegments(const std::vector<Segment>& a, const std::vector<Segment>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Segment& x, const Segment& y) {
    return x.length == y.length && x.curvature == y.curvature && x.sharpness == y.sharpness &&
           x.direction == y.direction;
  });
}

TEST(FastestLeg, SolvesEqualProgramsOnce) {
  const FastestLeg leg = LegFrom(WordTo({12.0, 9.0, 2.0}), 0.0, 0.0, 2);
  std::vector<FastestLeg> others;
  for (const double goal : {8.0, 9.5}) {
    others.push_back(LegFrom(WordTo({12.0, goal, 2.0}), 0.0, 0.0, 2));
  }
  others.push_back(LegFrom(leg.start, 0.0, kPriusLimits.speed.speed, 2));
  others.push_back(leg);
  others.back().limits.steering_rate *= 1.01;
  others.push_back(leg);
  others.back().limits.lateral *= 0.99;
  others.push_back(leg);
  others.back().min_speed = 0.5;
  FasterLegs legs;
  const auto first = legs.Find(leg);
  ASSERT_TRUE(first);
  EXPECT_EQ(legs.size(), 1U);
  // Programs of other legs must not replace the solution, or be replaced by it.
  for (std::size_t i = 0; i < others.size(); ++i) {
    SCOPED_TRACE(i);
    const auto found = legs.Find(others[i]);
    const auto alone = FasterLegs().Find(others[i]);
    ASSERT_TRUE(found && alone);
    EXPECT_TRUE(SameSegments(*found, *alone));
    EXPECT_EQ(legs.size(), i + 2);
  }
  const auto again = legs.Find(leg);
  ASSERT_TRUE(again);
  EXPECT_TRUE(SameSegments(*first, *again));
  EXPECT_EQ(legs.size(), others.size() + 1);
}

TEST(FastestLeg, LeavesAStraight) {
  const std::vector<Segment> straight{{.length = 20.0}};
  for (const double speed : {0.0, kPriusLimits.speed.speed}) {
    const auto found = FasterLegs().Find(LegFrom(straight, speed, speed, 3));
    ASSERT_TRUE(found);
    // The goal is met to 1e-10 m, at speeds of up to 3 m/s.
    EXPECT_NEAR(TimeOf(*found, speed, speed), TimeOf(straight, speed, speed), Tolerance(1e-10));
    for (const Segment& segment : *found) {
      EXPECT_NEAR(segment.curvature, 0.0, Tolerance(1e-12));
    }
    // A single piece cannot meet a goal of three coordinates.
    EXPECT_FALSE(FasterLegs().Find(LegFrom(straight, speed, speed, 1)));
  }
}

}  // namespace
}  // namespace trackbed
