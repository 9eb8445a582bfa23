#include "trackbed/planning/sampling/comparator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Returns two legs from (0, 0) via (5, height) to (10, 0).
std::vector<Vec2> Over(double height) {
  return {{0.0, 0.0}, {5.0, height}, {10.0, 0.0}};
}

PathScore Score(const std::vector<Vec2>& way, const Vec2& position,
                const std::vector<OrientedBox>& obstacles = {}, const WindScoring& wind = {},
                const ComparatorOptions& options = {}) {
  return ScorePath(way, position, obstacles, 0.5, wind, options);
}

TEST(Comparator, CountsWhatIsLeft) {
  EXPECT_NEAR(Score(Over(0.0), {0.0, 0.0}).length, 10.0, Tolerance(1e-12));
  EXPECT_NEAR(Score(Over(0.0), {4.0, 3.0}).length, 3.0 + 6.0, Tolerance(1e-12));
  EXPECT_NEAR(Score(Over(0.0), {12.0, 0.0}).length, 2.0, Tolerance(1e-12));
  EXPECT_NEAR(Score(Over(0.0), {-1.0, 0.0}).length, 11.0, Tolerance(1e-12));
  // At a corner, the score equals the cost by which the wind-aware RRT connects the nearest node.
  EXPECT_NEAR(Score(Over(12.0), {5.0, 12.0}).length, 13.0, Tolerance(1e-12));
}

TEST(Comparator, TakesTheShorterWay) {
  EXPECT_TRUE(IsBetter(Score(Over(1.0), {0, 0}), Score(Over(2.0), {0, 0})));
  EXPECT_FALSE(IsBetter(Score(Over(2.0), {0, 0}), Score(Over(1.0), {0, 0})));
}

TEST(Comparator, KeepsTheCurrentWayOnATie) {
  EXPECT_FALSE(IsBetter(Score(Over(1.0), {0, 0}), Score(Over(-1.0), {0, 0})));
  EXPECT_FALSE(IsBetter(Score(Over(-1.0), {0, 0}), Score(Over(1.0), {0, 0})));
}

TEST(Comparator, APenaltyTurnsTheChoice) {
  const std::vector<OrientedBox> boxes{{{5.0, 0.5, 0.0}, 1.0, 1.0}};
  const PathScore through = Score(Over(0.0), {0, 0}, boxes);
  const PathScore around = Score(Over(4.0), {0, 0}, boxes);
  EXPECT_TRUE(through.collides);
  EXPECT_FALSE(around.collides);
  EXPECT_TRUE(IsBetter(around, through));
  EXPECT_NEAR(through.total, through.length + 1000.0, Tolerance(1e-9));
  // Without a penalty the shorter path is better, even through the box.
  EXPECT_TRUE(IsBetter(Score(Over(0.0), {0, 0}, boxes, {}, {.collision_penalty = 0.0}), around));
  // Obstacles behind the car are ignored.
  EXPECT_FALSE(Score(Over(0.0), {7.0, 0.0}, boxes).collides);
}

TEST(Comparator, UniformWindDoesNotMatter) {
  const WindScoring wind{.wind = {.velocity = {-2.0, 1.0}}, .speed = 3.0};
  const PathScore low = Score(Over(1.0), {0, 0}, {}, wind);
  const PathScore high = Score(Over(3.0), {0, 0}, {}, wind);
  EXPECT_NEAR(low.wind, high.wind, Tolerance(1e-12));
  EXPECT_TRUE(IsBetter(low, high));
}

TEST(Comparator, LayersOfWindTurnTheChoice) {
  // The wind is a tailwind above the x axis and a headwind below it, both of 1 m/s. At V = 3 m/s, a
  // wind of 1 m/s changes the cost of a path by a third of its length.
  const OrientedBox above{{5.0, 5.0, 0.0}, 20.0, 10.0};
  const OrientedBox below{{5.0, -5.0, 0.0}, 20.0, 10.0};
  const auto layer = [](const OrientedBox& area, double speed) {
    return Gust{.velocity = {speed, 0.0}, .shape = GustShape::kStep, .area = area};
  };
  const WindScoring wind{.wind = {.gusts = {layer(above, 1.0), layer(below, -1.0)}}, .speed = 3.0};
  const std::vector<Vec2> shorter = Over(-1.0);
  const std::vector<Vec2> longer = Over(2.0);
  EXPECT_TRUE(IsBetter(Score(shorter, {0, 0}), Score(longer, {0, 0})));
  EXPECT_TRUE(IsBetter(Score(longer, {0, 0}, {}, wind), Score(shorter, {0, 0}, {}, wind)));
  WindScoring ignored = wind;
  ignored.weight = 0.0;
  EXPECT_TRUE(IsBetter(Score(shorter, {0, 0}, {}, ignored), Score(longer, {0, 0}, {}, ignored)));
}

TEST(Comparator, OfAWayOfOnePointTheWayThereIsLeft) {
  EXPECT_NEAR(Score({{3.0, 4.0}}, {0.0, 0.0}).length, 5.0, Tolerance(1e-12));
  EXPECT_TRUE(Score({{3.0, 4.0}}, {0.0, 0.0}, {{{3.0, 4.0, 0.0}, 1.0, 1.0}}).collides);
  EXPECT_THROW(Score({}, {0.0, 0.0}), InternalError);
}

}  // namespace
}  // namespace trackbed
