#include "trackbed/path/reference.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

// Tests speed profiles: constant acceleration between knots, trapezoidal profiles with caps against
// knots computed by hand, and random profiles against their limits.
namespace trackbed {
namespace reference_test {

// Rounding error of a few operations on numbers below 1000.
constexpr double kRounding = 1e-12;
constexpr SpeedLimits kLimits{.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};

void ExpectKnots(const SpeedProfile& profile, const std::vector<SpeedProfile::Knot>& expected) {
  ASSERT_EQ(profile.knots().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(profile.knots()[i].s, expected[i].s, Tolerance(kRounding)) << "knot " << i;
    EXPECT_NEAR(profile.knots()[i].speed, expected[i].speed, Tolerance(kRounding)) << "knot " << i;
  }
}

TEST(SpeedProfile, SquareOfTheSpeedIsLinear) {
  const SpeedProfile profile({{2.0, 1.0}, {6.0, 3.0}, {10.0, 3.0}});
  EXPECT_NEAR(profile.SpeedAt(4.0), std::sqrt(5.0), Tolerance(kRounding));
  EXPECT_NEAR(profile.AccelerationAt(4.0), 1.0, Tolerance(kRounding));  // The acceleration is (3^2
                                                                        // - 1^2)/(2 x 4) m/s^2.
  EXPECT_EQ(profile.SpeedAt(8.0), 3.0);
  EXPECT_EQ(profile.AccelerationAt(8.0), 0.0);
  EXPECT_EQ(profile.SpeedAt(0.0), 1.0);
  EXPECT_EQ(profile.SpeedAt(20.0), 3.0);
  EXPECT_EQ(profile.AccelerationAt(1.0), 0.0);
  EXPECT_EQ(profile.AccelerationAt(20.0), 0.0);
}

TEST(SpeedProfile, AccelerationBelongsToTheSideOfLargerStations) {
  const SpeedProfile profile({{0.0, 1.0}, {4.0, 3.0}, {8.0, 0.0}});
  EXPECT_NEAR(profile.AccelerationAt(0.0), 1.0, Tolerance(kRounding));
  EXPECT_NEAR(profile.AccelerationAt(4.0), -9.0 / 8.0, Tolerance(kRounding));
  EXPECT_EQ(profile.AccelerationAt(8.0), 0.0);
}

TEST(SpeedProfile, TimeIsDistanceOverMeanSpeed) {
  const SpeedProfile profile({{2.0, 1.0}, {6.0, 3.0}, {12.0, 3.0}});
  EXPECT_EQ(profile.TimeAt(2.0), 0.0);
  EXPECT_EQ(profile.TimeAt(0.0), 0.0);
  EXPECT_NEAR(profile.TimeAt(6.0), 2.0, Tolerance(kRounding));
  EXPECT_NEAR(profile.TimeAt(4.0), std::sqrt(5.0) - 1.0, Tolerance(kRounding));  // The speed rises
                                                                                 // from 1 to
                                                                                 // sqrt(5) m/s at 1
                                                                                 // m/s^2.
  EXPECT_NEAR(profile.TimeAt(12.0), 4.0, Tolerance(kRounding));
  EXPECT_NEAR(profile.TimeAt(15.0), 5.0, Tolerance(kRounding));
}

TEST(SpeedProfile, StationIsTheInverseOfTime) {
  const SpeedProfile profile({{2.0, 1.0}, {6.0, 3.0}, {12.0, 3.0}, {15.0, 0.0}});
  for (double s = 2.0; s < 15.0; s += 0.37) {
    EXPECT_NEAR(profile.StationAt(profile.TimeAt(s)), s, Tolerance(kRounding));
  }
  EXPECT_EQ(profile.StationAt(0.0), 2.0);
  EXPECT_NEAR(profile.StationAt(1.0), 2.0 + 1.5, Tolerance(kRounding));  // The distance is v t + a
                                                                         // t^2/2 with v = 1 m/s, a
                                                                         // = 1 m/s^2 and t = 1 s.
  EXPECT_EQ(profile.StationAt(100.0), 15.0);
  EXPECT_NEAR(SpeedProfile({{1.0, 2.0}}).StationAt(3.0), 7.0, Tolerance(kRounding));
  EXPECT_EQ(SpeedProfile({{0.0, 0.0}, {3.0, 0.0}}).StationAt(9.0), 0.0);
  EXPECT_EQ(SpeedProfile().StationAt(1.0), 0.0);
}

TEST(SpeedProfile, StandstillTakesForEver) {
  constexpr double kForEver = std::numeric_limits<double>::infinity();
  const SpeedProfile stopping({{0.0, 3.0}, {3.0, 0.0}});
  EXPECT_NEAR(stopping.TimeAt(3.0), 2.0, Tolerance(kRounding));
  EXPECT_EQ(stopping.TimeAt(3.1), kForEver);
  EXPECT_EQ(SpeedProfile({{0.0, 0.0}, {3.0, 0.0}}).TimeAt(1.0), kForEver);
}

TEST(SpeedProfile, WithoutKnotsStands) {
  EXPECT_EQ(SpeedProfile().SpeedAt(1.0), 0.0);
  EXPECT_EQ(SpeedProfile().AccelerationAt(1.0), 0.0);
  EXPECT_EQ(SpeedProfile().TimeAt(1.0), 0.0);
}

TEST(SpeedProfile, OfOneKnotIsConstant) {
  const SpeedProfile profile({{1.0, 2.0}});
  EXPECT_EQ(profile.SpeedAt(-5.0), 2.0);
  EXPECT_EQ(profile.SpeedAt(5.0), 2.0);
  EXPECT_EQ(profile.AccelerationAt(5.0), 0.0);
  EXPECT_NEAR(profile.TimeAt(5.0), 2.0, Tolerance(kRounding));
}

TEST(SpeedProfile, ChecksItsKnots) {
  EXPECT_THROW(SpeedProfile({{0.0, -1.0}}), InternalError);
  EXPECT_THROW(SpeedProfile({{0.0, std::nan("")}}), InternalError);
  EXPECT_THROW(SpeedProfile({{0.0, 1.0}, {0.0, 2.0}}), InternalError);
  EXPECT_THROW(SpeedProfile({{1.0, 1.0}, {0.0, 2.0}}), InternalError);
}

TEST(StopAtEnd, IsATrapezoid) {
  // Accelerating to the limit takes 3^2/(2 x 1) = 4.5 m, and stopping takes 3^2/(2 x 1.5) = 3 m.
  ExpectKnots(StopAtEnd(100.0, 0.0, kLimits), {{0, 0}, {4.5, 3}, {97, 3}, {100, 0}});
  // Accelerating takes 3 s, driving at the limit 92.5/3 s, and braking 2 s.
  EXPECT_NEAR(StopAtEnd(100.0, 0.0, kLimits).TimeAt(100.0), 5.0 + 92.5 / 3.0, Tolerance(kRounding));
}

TEST(StopAtEnd, LeavesAtTheStartSpeed) {
  ExpectKnots(StopAtEnd(100.0, 3.0, kLimits), {{0, 3}, {97, 3}, {100, 0}});
  ExpectKnots(StopAtEnd(100.0, 1.0, kLimits), {{0, 1}, {4, 3}, {97, 3}, {100, 0}});
}

TEST(StopAtEnd, SlowsDownToTheLimit) {
  // Braking from 4 to 3 m/s takes (4^2 - 3^2)/(2 x 1.5) = 7/3 m.
  ExpectKnots(StopAtEnd(100.0, 4.0, kLimits), {{0, 4}, {7.0 / 3.0, 3}, {97, 3}, {100, 0}});
}

TEST(StopAtEnd, PeaksBelowTheLimitWhereThereIsNoRoom) {
  // The peak speed v satisfies v^2/2 + v^2/3 = 5 m^2/s^2, so v^2 = 6 m^2/s^2. The peak is at 3 m.
  ExpectKnots(StopAtEnd(5.0, 0.0, kLimits), {{0, 0}, {3, std::sqrt(6.0)}, {5, 0}});
  // From 1 m/s, the peak speed v satisfies (v^2 - 1)/2 + v^2/3 = 4.5, so v^2 = 6. The peak is at
  // 2.5 m.
  ExpectKnots(StopAtEnd(4.5, 1.0, kLimits), {{0, 1}, {2.5, std::sqrt(6.0)}, {4.5, 0}});
}

TEST(StopAtEnd, BrakesHarderWhereItMust) {
  const SpeedProfile profile = StopAtEnd(1.0, 3.0, kLimits);
  ExpectKnots(profile, {{0, 3}, {1, 0}});
  EXPECT_NEAR(profile.AccelerationAt(0.5), -4.5, Tolerance(kRounding));
  ExpectKnots(StopAtEnd(1.0, 5.0, kLimits), {{0, 5}, {1, 0}});
}

// --- Caps ---------------------------------------------------------------------------------------

TEST(StopAtEnd, SlowsDownForACapAndSpeedsUpAfterIt) {
  // Braking from 3 to 2 m/s at 1.5 m/s^2 takes 5/3 m. Accelerating back at 1 m/s^2 takes 2.5 m, and
  // stopping takes 3 m.
  const SpeedProfile profile = StopAtEnd(40.0, 3.0, {3.0, 1.0, 1.5}, {{10.0, 15.0, 2.0}});
  const std::vector<SpeedProfile::Knot>& knots = profile.knots();
  const std::vector<double> stations{0.0, 10.0 - 5.0 / 3.0, 10.0, 15.0, 17.5, 37.0, 40.0};
  const std::vector<double> speeds{3.0, 3.0, 2.0, 2.0, 3.0, 3.0, 0.0};
  ASSERT_EQ(knots.size(), stations.size());
  for (std::size_t i = 0; i < knots.size(); ++i) {
    EXPECT_NEAR(knots[i].s, stations[i], Tolerance(1e-12)) << i;
    EXPECT_NEAR(knots[i].speed, speeds[i], Tolerance(1e-12)) << i;
  }
}

TEST(StopAtEnd, PeaksBetweenCapsThatAreClose) {
  // Between the caps of 1 m/s, from 10 m to 13 m, the car accelerates at 1 m/s^2 and brakes at 1.5
  // m/s^2. The peak is 1.8 m after the first cap, with v^2 = 1 + 2 x 1.8 = 4.6.
  const SpeedProfile profile =
      StopAtEnd(40.0, 1.0, {3.0, 1.0, 1.5}, {{0.0, 10.0, 1.0}, {13.0, 20.0, 1.0}});
  EXPECT_NEAR(profile.SpeedAt(11.8), std::sqrt(4.6), Tolerance(1e-12));
  EXPECT_EQ(profile.SpeedAt(13.0), 1.0);
}

TEST(StopAtEnd, BrakesHarderBeforeANearCap) {
  // Braking from 3 to 1 m/s within 2 m needs (3^2 - 1^2)/(2 x 2) = 2 m/s^2, more than the limit of
  // 1.5 m/s^2.
  const SpeedProfile profile = StopAtEnd(40.0, 3.0, {3.0, 1.0, 1.5}, {{2.0, 5.0, 1.0}});
  EXPECT_NEAR(profile.AccelerationAt(1.0), -2.0, Tolerance(1e-12));
  EXPECT_NEAR(profile.SpeedAt(3.0), 1.0, Tolerance(1e-12));
}

TEST(StopAtEnd, KeepsRandomCaps) {
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    const double length = random.Uniform(1.0, 200.0);
    const SpeedLimits limits{random.Uniform(0.5, 10.0), random.Uniform(0.2, 3.0),
                             random.Uniform(0.2, 3.0)};
    const double start = random.Uniform(0.0, limits.speed);
    std::vector<SpeedCap> caps;
    for (int k = 0; k < i % 5; ++k) {
      const double from = random.Uniform(0.01, length);
      caps.push_back({from, from + random.Uniform(0.0, 20.0), random.Uniform(0.3, limits.speed)});
    }
    SCOPED_TRACE(::testing::Message() << "case " << i);
    const SpeedProfile profile = StopAtEnd(length, start, limits, caps);
    EXPECT_EQ(profile.SpeedAt(0.0), start);
    EXPECT_EQ(profile.SpeedAt(length), 0.0);
    bool hard = start * start / (2.0 * length) > limits.deceleration;
    for (const SpeedCap& cap : caps) {
      hard = hard || start * start - cap.speed * cap.speed > 2.0 * limits.deceleration * cap.from;
    }
    for (double s = 0.0; s < length; s += 0.05) {
      EXPECT_LE(profile.SpeedAt(s), limits.speed + 1e-9) << s;
      EXPECT_LE(profile.AccelerationAt(s), limits.acceleration + 1e-6) << s;
      if (!hard) {
        EXPECT_GE(profile.AccelerationAt(s), -limits.deceleration - 1e-6) << s;
      }
      for (const SpeedCap& cap : caps) {
        if (s >= cap.from + 1e-6 && s <= std::min(cap.to, length) - 1e-6) {
          EXPECT_LE(profile.SpeedAt(s), cap.speed + 1e-6) << s;
        }
      }
    }
  }
}

// The general speed limit is not a cap. The car brakes to this speed limit from the start, even if
// caps divide the path.
TEST(StopAtEnd, SlowsDownToTheLimitAcrossTheEndsOfCaps) {
  const std::vector<SpeedCap> caps{{1.0, 2.0, 6.9}, {2.0, 3.0, 6.8}};
  // Braking takes (4^2 - 3^2)/(2 x 1.5) = 7/3 m, as without caps.
  const SpeedProfile profile = StopAtEnd(100.0, 4.0, kLimits, caps);
  EXPECT_NEAR(profile.AccelerationAt(0.5), -1.5, Tolerance(1e-12));
  EXPECT_NEAR(profile.AccelerationAt(2.2), -1.5, Tolerance(1e-12));
  EXPECT_NEAR(profile.SpeedAt(7.0 / 3.0), 3.0, Tolerance(1e-12));
  EXPECT_NEAR(profile.SpeedAt(50.0), 3.0, Tolerance(1e-12));
}

// The car must not brake harder than the maximum deceleration. At each station, its speed must not
// exceed the larger of two speeds: its limit, and the speed of a car that brakes at the maximum
// deceleration from the start.
TEST(StopAtEnd, SlowsDownGentlyToCapsThatAreNotStrict) {
  Random random(23);
  for (int i = 0; i < 2000; ++i) {
    const SpeedLimits limits{random.Uniform(0.5, 10.0), random.Uniform(0.2, 3.0),
                             random.Uniform(0.2, 3.0)};
    const double start = random.Uniform(0.0, 12.0);
    const double length = start * start / (2.0 * limits.deceleration) + random.Uniform(1.0, 100.0);
    std::vector<SpeedCap> caps;
    double s = 0.0;
    while (s < length) {
      const double to = s + random.Uniform(0.05, 5.0);
      caps.push_back({s, to, random.Uniform(0.1, 10.0), /*strict=*/false});
      s = to;
    }
    SCOPED_TRACE(::testing::Message() << "case " << i);
    const SpeedProfile profile = StopAtEnd(length, start, limits, caps);
    EXPECT_EQ(profile.SpeedAt(0.0), start);
    EXPECT_EQ(profile.SpeedAt(length), 0.0);
    for (std::size_t k = 1; k < profile.knots().size(); ++k) {
      const auto& [from, v_from] = profile.knots()[k - 1];
      const auto& [until, v_to] = profile.knots()[k];
      // The rounding error of v^2 is 1e-14 of its largest value 144 m^2/s^2. Divided by the length
      // of the interval, at least 1e-9 m, it becomes an error of the acceleration.
      const double rounding = 1e-6 + 2e-12 / (until - from);
      EXPECT_GE((v_to * v_to - v_from * v_from) / (2.0 * (until - from)),
                -limits.deceleration - rounding);
    }
    for (const SpeedCap& cap : caps) {
      for (const double share : {0.1, 0.5, 0.9}) {
        const double at = std::lerp(cap.from, std::min(cap.to, length), share);
        const double braked = start * start - 2.0 * limits.deceleration * at;
        const double allowed = std::min(cap.speed, limits.speed);
        EXPECT_LE(profile.SpeedAt(at),
                  std::sqrt(std::max(allowed * allowed, braked)) + Tolerance(1e-6))
            << at;
      }
    }
  }
}

TEST(StopAtEnd, OfNoLengthStands) {
  ExpectKnots(StopAtEnd(0.0, 0.0, kLimits), {{0, 0}});
}

TEST(StopAtEnd, KeepsItsLimitsOnRandomMissions) {
  Random random(51);
  for (int i = 0; i < 2000; ++i) {
    const SpeedLimits limits{.speed = random.Uniform(0.1, 10.0),
                             .acceleration = random.Uniform(0.1, 5.0),
                             .deceleration = random.Uniform(0.1, 5.0)};
    const double length = random.Uniform(0.01, 60.0);
    const double start = random.Below(3) == 0 ? 0.0 : random.Uniform(0.0, 10.0);
    SCOPED_TRACE(fmt::format("case {}: length {}, start {}, speed {}, acceleration {}, {}", i,
                             length, start, limits.speed, limits.acceleration,
                             limits.deceleration));
    const SpeedProfile profile = StopAtEnd(length, start, limits);
    const auto& knots = profile.knots();
    EXPECT_EQ(knots.front().s, 0.0);
    EXPECT_EQ(knots.front().speed, start);
    EXPECT_EQ(knots.back().s, length);
    EXPECT_EQ(knots.back().speed, 0.0);
    const double stop = start * start / (2.0 * length);  // The deceleration that is needed to stop
                                                         // at the end of the path.
    double time = 0.0;
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
      const double middle = 0.5 * (knots[k].s + knots[k + 1].s);
      const double a = profile.AccelerationAt(middle);
      // The rounding error of v^2, which is up to 100 m^2/s^2, is divided by the length of the
      // interval, which may be short.
      const double tolerance = Tolerance(1e-12 / std::min(1.0, knots[k + 1].s - knots[k].s));
      EXPECT_LE(a, limits.acceleration + tolerance);
      EXPECT_GE(a, -std::max(limits.deceleration, stop) - tolerance);
      EXPECT_LE(profile.SpeedAt(middle), std::max(start, limits.speed) + Tolerance(kRounding));
      // Adds the time over an interval of constant acceleration.
      time += a == 0.0 ? (knots[k + 1].s - knots[k].s) / knots[k].speed
                       : (knots[k + 1].speed - knots[k].speed) / a;
    }
    EXPECT_NEAR(profile.TimeAt(length), time, Tolerance(1e-9 * std::max(1.0, time)));
  }
}

Path ThereAndBack() {
  return Path(
      {}, {{.length = 20.0}, {.length = 8.0, .curvature = 0.1, .direction = -1}, {.length = 12.0}});
}

TEST(StopAtCusps, StopsAtEveryChangeOfDirection) {
  const SpeedLimits limits{.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  const SpeedProfile profile =
      StopAtCusps(ThereAndBack(), 1.0, limits, {{10.0, 22.0, 2.0}, {25.0, 30.0, 1.0}});
  EXPECT_EQ(profile.SpeedAt(0.0), 1.0);
  for (const double s : {20.0, 28.0, 40.0}) {
    EXPECT_EQ(profile.SpeedAt(s), 0.0) << s;
  }
  EXPECT_NEAR(profile.SpeedAt(15.0), 2.0, Tolerance(1e-12));
  EXPECT_NEAR(profile.SpeedAt(26.0), 1.0, Tolerance(1e-12));
  for (double s = 0.0; s < 40.0; s += 0.1) {
    EXPECT_LE(profile.AccelerationAt(s), 1.0 + Tolerance(1e-9));
    EXPECT_GE(profile.AccelerationAt(s), -1.5 - Tolerance(1e-9));
  }
  EXPECT_TRUE(std::isfinite(profile.TimeAt(40.0)));
}

TEST(StopAtCusps, KeepsTheKindOfItsCaps) {
  const SpeedLimits limits{.speed = 9.0, .acceleration = 1.0, .deceleration = 1.5};
  const std::vector<SpeedCap> caps{{0.0, 1.0, 5.0, false}, {1.0, 100.0, 4.0, false}};
  const SpeedProfile profile = StopAtCusps(Path({}, {{.length = 100.0}}), 6.0, limits, caps);
  EXPECT_NEAR(profile.AccelerationAt(0.5), -1.5, Tolerance(1e-12));
}

TEST(Excerpt, HoldsNothingOfTheLegBefore) {
  // The lengths of the segments have no exact binary representation, so their sums have rounding
  // errors. These errors must not add a piece of the previous leg.
  const SpeedLimits limits{.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  std::vector<Segment> segments;
  for (int i = 0; i < 40; ++i) {
    segments.push_back(
        {.length = 0.1 + 0.37 * i, .curvature = 0.01 * i, .direction = i % 4 < 2 ? 1 : -1});
  }
  const Path path({}, segments);
  const Reference whole{path, StopAtCusps(path, 0.0, limits)};
  int direction = 1;
  for (const Stations& leg : SplitIntoLegs(path)) {
    const std::vector<Segment> own = Excerpt(whole, leg).path.segments();
    ASSERT_EQ(own.size(), 2U);
    EXPECT_EQ(own[0].direction, direction);
    EXPECT_EQ(own[1].direction, direction);
    direction = -direction;
  }
}

TEST(StopAtCusps, IsStopAtEndWithoutCusps) {
  const SpeedLimits limits{.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  const SpeedProfile a = StopAtCusps(Path({}, {{.length = 30.0}}), 1.0, limits);
  const SpeedProfile b = StopAtEnd(30.0, 1.0, limits);
  ASSERT_EQ(a.knots().size(), b.knots().size());
  for (std::size_t i = 0; i < a.knots().size(); ++i) {
    EXPECT_EQ(a.knots()[i].s, b.knots()[i].s);
    EXPECT_EQ(a.knots()[i].speed, b.knots()[i].speed);
  }
}

TEST(Excerpt, IsTheReferenceOfALeg) {
  const SpeedLimits limits{.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  const Reference whole{ThereAndBack(), StopAtCusps(ThereAndBack(), 1.0, limits)};
  for (const Stations& leg : SplitIntoLegs(whole.path)) {
    const Reference own = Excerpt(whole, leg);
    EXPECT_NEAR(own.path.length(), leg.to - leg.from, Tolerance(1e-12));
    EXPECT_EQ(own.speed.knots().front().s, 0.0);
    EXPECT_EQ(own.speed.knots().back().speed, 0.0);
    for (double s = 0.0; s < own.path.length(); s += 0.7) {
      EXPECT_NEAR(own.speed.SpeedAt(s), whole.speed.SpeedAt(leg.from + s), Tolerance(1e-9));
      EXPECT_NEAR(
          (own.path.At(s).pose.position() - whole.path.At(leg.from + s).pose.position()).norm(),
          0.0, Tolerance(1e-12));
      EXPECT_EQ(own.path.At(s).direction, whole.path.At(leg.from + s).direction);
    }
  }
}

}  // namespace reference_test
}  // namespace trackbed
