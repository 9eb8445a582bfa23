#include "trackbed/falsify/shrink.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

SearchSpace UnitSpace(const std::vector<double>& nominal) {
  std::vector<SearchKey> keys;
  for (const double value : nominal) {
    keys.push_back({.key = "k" + std::to_string(keys.size()), .nominal = value});
  }
  return SearchSpace(keys);
}

EvaluatePoint By(std::function<double(const UnitPoint&)> robustness) {
  return [=](const UnitPoint& point) -> std::optional<Evaluation> {
    const double value = robustness(point);
    return Evaluation{.robustness = value, .violated = value < 0.0};
  };
}

/// Values are rounded to a thousandth of the range.
constexpr double kStep = 1e-3;
constexpr double kTolerance = 0.01;

TEST(Shrink, ReachesTheBoundaryAlongTheRay) {
  const SearchSpace space = UnitSpace({0.0, 0.0});
  const ShrinkResult shrunk = Shrink(space, {1.0, 1.0}, kTolerance,
                                     By([](const UnitPoint& p) { return 0.7 - p[0] - p[1]; }));
  ASSERT_TRUE(shrunk.complete);
  // The failing region's border is x + y = 0.7; its nearest point is (0.35, 0.35). The result is at
  // most one tolerance beyond this point in each key, and not nearer to the nominal point than the
  // border.
  EXPECT_GE(shrunk.distance, 0.35 * std::sqrt(2.0));
  EXPECT_LE(shrunk.distance, 0.35 * std::sqrt(2.0) + kTolerance);
  EXPECT_LT(shrunk.robustness, 0.0);
  for (std::size_t i = 0; i < 2; ++i) {
    const double holds = shrunk.keys[i].holds_to.value();
    EXPECT_LT(holds, shrunk.point[i]);
    EXPECT_NEAR(holds, shrunk.point[i], kTolerance + kStep);
    EXPECT_GE(0.7 - holds - shrunk.point[1 - i], 0.0);
    EXPECT_NEAR(shrunk.keys[i].sensitivity.value(), -1.0, 1e-9);
    // A single key fails only above 0.7.
    EXPECT_FALSE(shrunk.keys[i].down.has_value());
    EXPECT_FALSE(shrunk.keys[i].up.value().whole_range);
    EXPECT_LE(shrunk.keys[i].up.value().passes, 0.7 + kStep);
    EXPECT_GE(shrunk.keys[i].up.value().passes, 0.7 - kTolerance - kStep);
  }
}

TEST(Shrink, LeavesWhatDoesNotMatterAtItsNominalValue) {
  const SearchSpace space = UnitSpace({0.5, 0.25, 0.5});
  const ShrinkResult shrunk =
      Shrink(space, {0.1, 0.9, 0.8}, kTolerance, By([](const UnitPoint& p) { return 0.6 - p[1]; }));
  ASSERT_TRUE(shrunk.complete);
  EXPECT_EQ(shrunk.point[0], 0.5);
  EXPECT_EQ(shrunk.point[2], 0.5);
  EXPECT_GT(shrunk.point[1], 0.6);
  EXPECT_LE(shrunk.point[1], 0.6 + kTolerance + kStep);
  EXPECT_FALSE(shrunk.keys[0].holds_to.has_value());
  EXPECT_EQ(shrunk.keys[0].sensitivity, 0.0);
  EXPECT_TRUE(shrunk.keys[0].up.value().whole_range);
  EXPECT_TRUE(shrunk.keys[1].down.value().whole_range);
  EXPECT_FALSE(shrunk.keys[1].up.value().whole_range);
}

/// Uses random violating balls and slabs without a value.
TEST(Shrink, NeverEndsAtAPointThatPasses) {
  std::mt19937 random(27);
  std::uniform_real_distribution<double> unit;
  int shrunk_count = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const SearchSpace space = UnitSpace({unit(random), unit(random), unit(random)});
    std::vector<std::pair<UnitPoint, double>> balls;
    for (int i = 0; i < 5; ++i) {
      balls.push_back({{unit(random), unit(random), unit(random)}, 0.1 + 0.4 * unit(random)});
    }
    const double hole = unit(random);
    int runs = 0;
    const auto robustness = [&](const UnitPoint& p) {
      double least = 1.0;
      for (const auto& [center, radius] : balls) {
        least = std::min(least, Distance(p, center) - radius);
      }
      return least;
    };
    const EvaluatePoint evaluate = [&](const UnitPoint& p) -> std::optional<Evaluation> {
      ++runs;
      if (std::abs(p[2] - hole) < 0.02) {
        return Evaluation{};
      }
      return Evaluation{.robustness = robustness(p), .violated = robustness(p) < 0.0};
    };
    const UnitPoint from = space.Snap({unit(random), unit(random), unit(random)});
    if (evaluate(space.nominal())->violated || !evaluate(from)->violated) {
      continue;
    }
    ++shrunk_count;
    runs = 0;
    const ShrinkResult shrunk = Shrink(space, from, kTolerance, evaluate);
    EXPECT_TRUE(shrunk.complete);
    EXPECT_TRUE(evaluate(shrunk.point)->violated);
    EXPECT_EQ(shrunk.robustness, robustness(shrunk.point));
    EXPECT_LE(shrunk.distance, Distance(from, space.nominal()));
    for (std::size_t i = 0; i < 3; ++i) {
      if (shrunk.keys[i].holds_to) {
        UnitPoint nearer = shrunk.point;
        nearer[i] = *shrunk.keys[i].holds_to;
        EXPECT_FALSE(evaluate(nearer)->violated);
      }
    }
    EXPECT_LT(runs, 1000);
  }
  EXPECT_GT(shrunk_count, 50);
}

TEST(Shrink, KeepsWhatItHasWhenTheRunsAreUsedUp) {
  const SearchSpace space = UnitSpace({0.0, 0.0});
  for (int most = 0; most < 40; ++most) {
    int runs = 0;
    const EvaluatePoint evaluate = [&](const UnitPoint& p) -> std::optional<Evaluation> {
      if (runs++ >= most) {
        return std::nullopt;
      }
      return Evaluation{.robustness = 0.7 - p[0] - p[1], .violated = p[0] + p[1] > 0.7};
    };
    const ShrinkResult shrunk = Shrink(space, {1.0, 0.5}, kTolerance, evaluate);
    EXPECT_GT(shrunk.point[0] + shrunk.point[1], 0.7) << most;
    EXPECT_EQ(shrunk.distance, Distance(shrunk.point, {0.0, 0.0}));
  }
}

TEST(Shrink, RefusesAPointThatPasses) {
  const SearchSpace space = UnitSpace({0.0});
  const auto never = By([](const UnitPoint&) { return 1.0; });
  EXPECT_THROW(Shrink(space, {1.0}, kTolerance, never), InternalError);
  const auto always = By([](const UnitPoint&) { return -1.0; });
  EXPECT_THROW(Shrink(space, {1.0}, kTolerance, always), InternalError);
  EXPECT_THROW(Shrink(space, {1.0}, 0.0, never), PreconditionError);
}

}  // namespace
}  // namespace trackbed
