#include "trackbed/planning/curves/continuous_curvature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/planning/poses.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"

namespace trackbed {
namespace {

/// One of the three kinds of curves.
struct Kind {
  const char* name;
  ShortestCurve (ContinuousCurves::*shortest)(const CurveState&, const CurveState&) const;
  std::vector<ShortestCurve> (ContinuousCurves::*words)(const CurveState&, const CurveState&) const;
  bool backwards;
  bool steps_at_cusps;
};

constexpr std::array<Kind, 3> kKinds{{
    {"CC-Dubins", &ContinuousCurves::Dubins, &ContinuousCurves::DubinsWords, false, false},
    {"CC-Reeds-Shepp", &ContinuousCurves::ReedsShepp, &ContinuousCurves::ReedsSheppWords, true,
     false},
    {"HC-Reeds-Shepp", &ContinuousCurves::HybridReedsShepp,
     &ContinuousCurves::HybridReedsSheppWords, true, true},
}};

/// The Prius at 3 m/s.
constexpr CurveLimits kCar{.radius = 5.61, .sharpness = 0.150568 / (2.7 * 3.0)};

CurveState RandomState(Random& random, double reach, double most) {
  CurveState state{RandomPose(random, reach), random.Uniform(-most, most)};
  // Straight wheels and full lock are the states of most plans.
  const double kind = random.Uniform(0.0, 1.0);
  if (kind < 0.4) {
    state.curvature = kind < 0.2 ? 0.0 : std::copysign(most, state.curvature);
  }
  return state;
}

/// Checks that a curve joins both states within the limits.
void ExpectJoins(const CurveLimits& limits, const Kind& kind, const CurveState& from,
                 const CurveState& to, const ShortestCurve& curve) {
  const std::vector<Segment> segments = ToSegments(curve);
  const Path path(from.pose, segments);
  ASSERT_LE(Apart(path.At(path.length()).pose, to.pose), Tolerance(1e-9)) << kind.name;
  // Rounding of sums of up to 1e3 r.
  ASSERT_NEAR(path.length(), curve.length, Tolerance(1e-11 * (limits.radius + curve.length)));
  const double rounding = Tolerance(1e-12);
  double curvature = from.curvature;
  int direction = segments.empty() ? 1 : segments.front().direction;
  for (const Segment& segment : segments) {
    const double end = segment.CurvatureAt(segment.length);
    const bool is_cusp = segment.direction != direction;
    ASSERT_TRUE(kind.backwards || segment.direction > 0);
    if (!is_cusp || !kind.steps_at_cusps) {
      ASSERT_NEAR(segment.curvature * limits.radius, curvature * limits.radius, rounding)
          << kind.name << " " << CurveWord(curve);
    }
    ASSERT_LE(std::max(std::abs(segment.curvature), std::abs(end)) * limits.radius, 1.0 + rounding);
    ASSERT_LE(std::abs(segment.sharpness) / limits.sharpness, 1.0 + rounding);
    ASSERT_EQ(segment.sharpness_rate, 0.0);
    curvature = end;
    direction = segment.direction;
  }
  ASSERT_NEAR(curvature * limits.radius, to.curvature * limits.radius, rounding);
}

TEST(ContinuousCurvature, JoinsRandomStatesWithinTheLimits) {
  Random random(1);
  for (int i = 0; i < 4000; ++i) {
    // From steering that is nearly instant to clothoids that turn by 4 rad.
    const double radius = random.Uniform(0.5, 12.0);
    const CurveLimits limits{radius, std::exp(random.Uniform(-2.0, 8.0)) / (radius * radius)};
    const CurveState from = RandomState(random, 20.0, 1.0 / radius);
    const CurveState to = RandomState(random, 20.0, 1.0 / radius);
    const ContinuousCurves curves(limits);
    for (const Kind& kind : kKinds) {
      ExpectJoins(limits, kind, from, to, (curves.*kind.shortest)(from, to));
    }
  }
}

TEST(ContinuousCurvature, JoinsStatesByEveryWord) {
  Random random(2);
  const ContinuousCurves curves(kCar);
  for (int i = 0; i < 60; ++i) {
    const CurveState from = RandomState(random, 20.0, 1.0 / kCar.radius);
    const CurveState to = RandomState(random, 20.0, 1.0 / kCar.radius);
    for (const Kind& kind : kKinds) {
      const auto words = (curves.*kind.words)(from, to);
      ASSERT_FALSE(words.empty());
      double shortest = words.front().length;
      if (kind.steps_at_cusps) {
        shortest = std::min(shortest, curves.ReedsShepp(from, to).length);
      }
      EXPECT_NEAR(shortest, (curves.*kind.shortest)(from, to).length, Tolerance(1e-11));
      for (const ShortestCurve& word : words) {
        ExpectJoins(kCar, kind, from, to, word);
      }
    }
  }
}

TEST(ContinuousCurvature, WordsBelowALengthAreTheFirstOfAllWords) {
  Random random(6);
  const ContinuousCurves curves(kCar);
  using WordsBelow = std::vector<ShortestCurve> (ContinuousCurves::*)(
      const CurveState&, const CurveState&, double) const;
  const std::vector<WordsBelow> below{&ContinuousCurves::DubinsWords,
                                      &ContinuousCurves::ReedsSheppWords,
                                      &ContinuousCurves::HybridReedsSheppWords};
  for (int i = 0; i < 40; ++i) {
    const CurveState from = RandomState(random, 20.0, 1.0 / kCar.radius);
    const CurveState to = RandomState(random, 20.0, 1.0 / kCar.radius);
    for (std::size_t k = 0; k < below.size(); ++k) {
      const std::vector<ShortestCurve> all = (curves.*kKinds[k].words)(from, to);
      const double longest = all[all.size() / 2].length * (1.0 - 1e-9);
      const std::vector<ShortestCurve> some = (curves.*below[k])(from, to, longest);
      const auto end = std::find_if(all.begin(), all.end(), [&](const ShortestCurve& word) {
        return word.length >= longest;
      });
      ASSERT_EQ(some.size(), static_cast<std::size_t>(end - all.begin()));
      for (std::size_t n = 0; n < some.size(); ++n) {
        EXPECT_EQ(CurveWord(some[n]), CurveWord(all[n]));
        EXPECT_EQ(some[n].length, all[n].length);
      }
    }
  }
}

TEST(ContinuousCurvature, JoinsPosesWhereCirclesTouch) {
  for (const double sharpness : {0.3, 1.0, 20.0}) {
    const CurveLimits limits{1.0, sharpness};
    const ContinuousCurves curves(limits);
    for (const Pose2& to : DegeneratePoses()) {
      for (const Kind& kind : kKinds) {
        ExpectJoins(limits, kind, {}, {to}, (curves.*kind.shortest)({}, {to}));
      }
    }
  }
}

TEST(ContinuousCurvature, IsNotShorterThanArcsAndApproachesThem) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const CurveState from{RandomPose(random, 20.0)};
    const CurveState to{RandomPose(random, 20.0)};
    const double radius = random.Uniform(1.0, 8.0);
    const double dubins = Dubins(from.pose, to.pose, radius).length;
    const double reeds_shepp = ReedsSheppLength(from.pose, to.pose, radius);
    // A clothoid that turns by 1/(2 units) moves a turn's circle by at most 1/units radii; each of
    // up to four turns has two. The straight and the angles of the arcs change by a few times that,
    // by its root where circles touch.
    for (const double units : {10.0, 1e4, 1e8}) {
      const ContinuousCurves curves({radius, units / (radius * radius)});
      const double most = radius * 16.0 / std::sqrt(units);
      for (const Kind& kind : kKinds) {
        const double arcs = kind.backwards ? reeds_shepp : dubins;
        const double length = (curves.*kind.shortest)(from, to).length;
        EXPECT_GE(length, arcs - Tolerance(1e-9)) << kind.name;
        EXPECT_LE(length, arcs + most +
                              (kind.backwards ? 0.0
                               : units < 1e8  ? HUGE_VAL
                                              : 0.0))
            << kind.name << " " << units;
      }
    }
  }
}

TEST(ContinuousCurvature, HasSymmetries) {
  Random random(4);
  const ContinuousCurves curves(kCar);
  constexpr double kScale = 3.5;
  const ContinuousCurves larger({kScale * kCar.radius, kCar.sharpness / (kScale * kScale)});
  for (int i = 0; i < 300; ++i) {
    const CurveState from = RandomState(random, 20.0, 1.0 / kCar.radius);
    const CurveState to = RandomState(random, 20.0, 1.0 / kCar.radius);
    const Pose2 moved = RandomPose(random, 50.0);
    const auto mirrored = [](const CurveState& state) {
      return CurveState{Mirror(state.pose), -state.curvature};
    };
    const auto scaled = [&](const CurveState& state) {
      return CurveState{{kScale * state.pose.x, kScale * state.pose.y, state.pose.yaw},
                        state.curvature / kScale};
    };
    const auto turned = [](const CurveState& state) {
      return CurveState{TurnedRound(state.pose), -state.curvature};
    };
    const auto composed = [&](const CurveState& state) {
      return CurveState{Compose(moved, state.pose), state.curvature};
    };
    for (const Kind& kind : kKinds) {
      const auto length = [&](const CurveState& a, const CurveState& b) {
        return (curves.*kind.shortest)(a, b).length;
      };
      const double own = length(from, to);
      const double rounding = Tolerance(1e-10) * (1.0 + own);
      EXPECT_NEAR(length(mirrored(from), mirrored(to)), own, rounding) << kind.name;
      EXPECT_NEAR(length(composed(from), composed(to)), own, rounding) << kind.name;
      EXPECT_NEAR(length(turned(to), turned(from)), own, rounding) << kind.name;
      EXPECT_NEAR((larger.*kind.shortest)(scaled(from), scaled(to)).length, kScale * own,
                  kScale * rounding);
      if (kind.backwards) {
        EXPECT_NEAR(length(to, from), own, rounding) << kind.name;
      }
    }
  }
}

/// Lengths by hbanzhaf's steering_functions at 79b9217, from the origin with a curvature to a
/// state.
struct PeerLengths {
  double curvature;
  Pose2 to;
  double end_curvature;
  // In the order of kKinds. The peer has no curves of the second kind for steered cars.
  std::array<double, 3> lengths;
};

TEST(ContinuousCurvature, FindsAWordOfTwoTurnsWithAShortStraight) {
  // Steering so slow that turns are spirals. A word of the length 22.198 m has a straight of 0.04
  // m, but no word has a straight at headings of the straight 0.1 rad beside it.
  const CurveLimits limits{1.0, 0.0900904};
  const CurveState from{{}, 0.052638};
  const CurveState to{{-1.250193, -1.250193, 0.0}, -0.236596};
  const ShortestCurve curve = ContinuousCurves(limits).Dubins(from, to);
  ExpectJoins(limits, kKinds[0], from, to, curve);
  // The states are rounded to 1e-6, and the length to 1e-3.
  EXPECT_LE(curve.length, 22.198 + Tolerance(1e-3));
}

TEST(ContinuousCurvature, IsNotLongerThanThePeer) {
  const std::vector<PeerLengths> rows{
      {0, {18, 20, -0.5}, 0, {61.471309791916, 46.163026889121, 47.107661334007}},
      {0, {-5, 14, -1.2}, 0, {53.722518498961, 39.250308643495, 38.106026324909}},
      {0, {16, 6, -1.9}, 0, {53.133424860842, 39.622911026469, 31.983581147462}},
      {0, {12, 2, -2}, 0, {48.689578715326, 45.034822665848, 45.034822665848}},
      {0, {4, 3, 2.3}, 0, {63.016623039946, 41.461850614252, 31.935026324909}},
      {0, {9, 0, -1.5}, 0, {64.224703842037, 47.567416026571, 36.423026324909}},
      {0, {-18, 20, -2.2}, 0, {52.954906295305, 34.800502496941, 34.800502496941}},
      {0, {-17, -9, 2.2}, 0, {46.887932771022, 44.244688498458, 35.370442381130}},
      {0, {6, -1, 2.2}, -0.07, {66.515799451683, HUGE_VAL, 29.469689055370}},
      {0.14, {-19, 9, 1.3}, 0.16, {68.149272917303, HUGE_VAL, 29.993884338973}},
      {-0.15, {5, -8, -1.8}, 0.03, {74.352296536745, HUGE_VAL, 36.775015367246}},
      {-0.03, {6, -3, -0.1}, 0, {80.909005412982, HUGE_VAL, 45.755106328628}},
      {0.16, {5, -8, -2.7}, 0.15, {75.778305621037, HUGE_VAL, 17.181077524835}},
      {0.05, {0, -16, -2.1}, 0.06, {62.430163756783, HUGE_VAL, 35.109677922004}},
      {-0.12, {11, -19, -2.4}, 0.15, {57.880264983727, HUGE_VAL, 32.666126290889}},
      {-0.09, {-9, -18, 1.1}, 0, {55.551559622604, HUGE_VAL, 32.641525306856}},
      // The shortest curve begins with a straight, then two turns with a cusp between them.
      {-0.1, {-32.3, 3, 2.9}, -0.16, {61.454279561050, HUGE_VAL, 45.912843527936}},
  };
  const ContinuousCurves curves(kCar);
  for (const PeerLengths& row : rows) {
    for (std::size_t i = 0; i < kKinds.size(); ++i) {
      const double own =
          (curves.*kKinds[i].shortest)({{}, row.curvature}, {row.to, row.end_curvature}).length;
      // The recorded lengths have 12 decimals.
      EXPECT_LE(own, row.lengths[i] * (1.0 + Tolerance(1e-11))) << kKinds[i].name;
    }
  }
}

TEST(ContinuousCurvature, FindsWhatIsPlain) {
  const ContinuousCurves curves(kCar);
  for (const Kind& kind : kKinds) {
    const auto shortest = [&](const CurveState& to) { return (curves.*kind.shortest)({}, to); };
    EXPECT_EQ(shortest({}).count, 0);
    EXPECT_NEAR(shortest({{0.5, 0.0, 0.0}}).length, 0.5, Tolerance(1e-11));
    EXPECT_EQ(CurveWord(shortest({{30.0, 0.0, 0.0}})), "S+");
    // Two clothoids that turn by a quarter of a radian.
    const double sharpness = kCar.sharpness;
    const double half = std::sqrt(0.25 / sharpness);
    const Path turn({}, {{half, 0.0, 1, sharpness}, {half, half * sharpness, 1, -sharpness}});
    const ShortestCurve found = shortest({turn.At(turn.length()).pose});
    EXPECT_NEAR(found.length, turn.length(), Tolerance(1e-9)) << kind.name;
  }
}

TEST(ContinuousCurvature, IsNeverLongerWithMoreFreedom) {
  Random random(8);
  for (int i = 0; i < 300; ++i) {
    const double radius = random.Uniform(0.5, 12.0);
    const ContinuousCurves curves(
        {radius, std::exp(random.Uniform(-2.0, 8.0)) / (radius * radius)});
    const CurveState from = RandomState(random, 20.0, 1.0 / radius);
    CurveState to = RandomState(random, 20.0, 1.0 / radius);
    if (i % 3 == 0) {
      to.pose = from.pose;
    }
    const double continuous = curves.ReedsShepp(from, to).length;
    const double rounding = Tolerance(1e-11 * (radius + continuous));
    EXPECT_LE(continuous, curves.Dubins(from, to).length + rounding);
    EXPECT_LE(curves.HybridReedsShepp(from, to).length, continuous + rounding);
  }
}

TEST(ContinuousCurvature, FollowsItsOwnClothoidsAndTurns) {
  // A goal on a clothoid of the largest sharpness, or behind two turns that touch, is at the edge
  // of the poses that such a path reaches. Rounding must not turn the path into loops.
  Random random(9);
  for (int i = 0; i < 400; ++i) {
    const double radius = random.Uniform(0.5, 12.0);
    const double sharpness = std::exp(random.Uniform(-2.0, 8.0)) / (radius * radius);
    const double most = 1.0 / radius;
    const double ramp = most / sharpness;
    std::vector<Segment> driven{{ramp * random.Uniform(0.1, 1.0), 0.0, 1, sharpness}};
    if (i % 2 == 1) {
      driven = {{ramp, 0.0, 1, sharpness},
                {radius * random.Uniform(0.1, 3.0), most},
                {ramp, most, 1, -sharpness},
                {ramp, 0.0, 1, -sharpness},
                {radius * random.Uniform(0.1, 3.0), -most},
                {ramp, -most, 1, sharpness}};
    }
    const CurveState from{RandomPose(random, 20.0)};
    const Path path(from.pose, driven);
    const double last = driven.back().CurvatureAt(driven.back().length);
    const CurveState to{path.At(path.length()).pose,
                        i % 2 == 1 ? 0.0 : std::min(last, 1.0 / radius)};
    const ContinuousCurves curves({radius, sharpness});
    const auto back = [](const CurveState& state) {
      return CurveState{TurnedRound(state.pose), -state.curvature};
    };
    for (const auto& [start, goal] : {std::pair(from, to), std::pair(back(to), back(from))}) {
      const ShortestCurve curve = curves.Dubins(start, goal);
      // The goal is rounded to 1e-15 of coordinates of 100 m.
      EXPECT_LE(curve.length, path.length() + Tolerance(1e-9)) << i << " " << CurveWord(curve);
      ExpectJoins(curves.limits(), kKinds[0], start, goal, curve);
    }
  }
}

TEST(ContinuousCurvature, GrowsGentlyWithAnOffset) {
  // A lateral offset h over the distance d costs about (h/d)^2 d; tolerances of positions and
  // headings of waypoints must not cost a loop. Four clothoids of d/4 lead aside by sigma d^3/32.
  const ContinuousCurves curves(kCar);
  for (const double distance : {0.5, 3.0, 12.0, 100.0}) {
    for (const double offset : {1e-12, 1e-9, 1e-6, 1e-5, 1e-4}) {
      for (const Kind& kind : kKinds) {
        for (const double side : {-1.0, 1.0}) {
          if (offset > kCar.sharpness * std::pow(distance, 3) / 100.0) {
            continue;
          }
          const ShortestCurve curve =
              (curves.*kind.shortest)({}, {{distance, side * offset, 0.5 * side * offset}});
          EXPECT_LT(curve.length, distance + offset + Tolerance(1e-9))
              << kind.name << " " << distance << " " << offset;
        }
      }
    }
  }
}

TEST(ContinuousCurvature, RefusesStatesItCannotHave) {
  const ContinuousCurves curves(kCar);
  const double above = 1.001 / kCar.radius;
  EXPECT_THROW(static_cast<void>(curves.Dubins({{}, above}, {{9.0, 1.0, 0.0}})), PreconditionError);
  EXPECT_THROW(static_cast<void>(curves.Dubins({}, {{9.0, 1.0, 0.0}, -above})), PreconditionError);
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(static_cast<void>(curves.Dubins({}, {{bad, 1.0, 0.0}})), PreconditionError);
    EXPECT_THROW(static_cast<void>(curves.ReedsShepp({{0.0, 0.0, bad}}, {})), PreconditionError);
    EXPECT_THROW(static_cast<void>(curves.ReedsShepp({{}, bad}, {})), PreconditionError);
    EXPECT_THROW(ContinuousCurves({.radius = bad}), InternalError);
  }
  EXPECT_THROW(ContinuousCurves({.sharpness = 0.0}), InternalError);
}

}  // namespace
}  // namespace trackbed
