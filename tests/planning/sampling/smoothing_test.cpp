#include "trackbed/planning/sampling/smoothing.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

std::vector<Vec2> Stairs() {
  return {{0, 0}, {0, 1}, {0, 2}, {1, 2}, {2, 2}, {3, 2}, {4, 2}, {4, 3}, {4, 4}};
}

std::vector<Vec2> RandomWay(Random& random, int points) {
  std::vector<Vec2> way;
  for (int i = 0; i < points; ++i) {
    way.push_back({random.Uniform(-20.0, 20.0), random.Uniform(-20.0, 20.0)});
  }
  return way;
}

TEST(Smoothing, SolvesItsLinearSystem) {
  Random random(21);
  for (const auto& [data, smoothness] : {std::pair(0.5, 0.1), {0.1, 0.3}, {0.3, 0.3}}) {
    const std::vector<Vec2> way = RandomWay(random, 12);
    const auto n = static_cast<Eigen::Index>(way.size());
    Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd given(n, 2);
    for (Eigen::Index i = 0; i < n; ++i) {
      given.row(i) = way[static_cast<std::size_t>(i)].transpose();
      if (i > 0 && i + 1 < n) {
        system(i, i) = data + 2.0 * smoothness;
        system(i, i - 1) = system(i, i + 1) = -smoothness;
        given.row(i) *= data;
      }
    }
    const Eigen::MatrixXd exact = system.partialPivLu().solve(given);
    const SmoothingResult result =
        SmoothPath(way, {}, 0.0, {}, {.data = data, .smoothness = smoothness, .tolerance = 1e-10});
    ASSERT_TRUE(result.converged);
    for (Eigen::Index i = 0; i < n; ++i) {
      // Each sweep multiplies the error by at most 1 - alpha. The remaining error is therefore at
      // most 1/alpha = 10 times the last change of 1e-10 m.
      EXPECT_NEAR((result.path[static_cast<std::size_t>(i)] - exact.row(i).transpose()).norm(), 0.0,
                  Tolerance(1e-9));
    }
  }
}

TEST(Smoothing, TakesSixteenSweepsForStairs) {
  const SmoothingResult result = SmoothPath(Stairs(), {}, 0.0, {}, {});
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.sweeps, 16);
  const std::vector<Vec2> published{{0, 0},           {0.0213, 0.9787}, {0.1489, 1.8511},
                                    {1.0213, 1.9787}, {2, 2},           {2.9787, 2.0213},
                                    {3.8511, 2.1489}, {3.9787, 3.0213}, {4, 4}};
  for (std::size_t i = 0; i < published.size(); ++i) {
    EXPECT_NEAR((result.path[i] - published[i]).norm(), 0.0, Tolerance(1e-4));  // four digits
  }
}

TEST(Smoothing, StopsAtItsCap) {
  const SmoothingResult result = SmoothPath(Stairs(), {}, 0.0, {}, {.sweeps = 3});
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.sweeps, 3);
  const SmoothingResult none = SmoothPath(Stairs(), {}, 0.0, {}, {.sweeps = 0});
  EXPECT_EQ(none.path, Stairs());
}

TEST(Smoothing, KeepsAFreeWayFree) {
  // The box is inside the corner of the staircase. Smoothing without obstacles would cut through
  // the box.
  const std::vector<OrientedBox> boxes{{{0.55, 1.45, 0.0}, 0.4, 0.4}};
  constexpr double kInflation = 0.3;
  const SmoothingResult result =
      SmoothPath(Stairs(), boxes, kInflation, {}, {.data = 0.1, .smoothness = 0.4});
  const auto nearest = [&](const std::vector<Vec2>& way) {
    double distance = 100.0;
    for (std::size_t i = 1; i < way.size(); ++i) {
      distance = std::min(distance, Distance(way[i - 1], way[i], boxes[0]));
    }
    return distance;
  };
  EXPECT_GT(nearest(result.path), kInflation);
  EXPECT_NE(result.path, Stairs());
  const SmoothingResult open = SmoothPath(Stairs(), {}, 0.0, {}, {.data = 0.1, .smoothness = 0.4});
  EXPECT_LT(nearest(open.path), kInflation);
}

TEST(Smoothing, AnObstacleMayHoldOneCoordinateAlone) {
  // The box under the corner reaches up to y = 1.15 m. With the smoothness 0.4, the point moves by
  // 0.4 (0 + 5 - 2 x 4) m = -1.2 m in x, to a free place. The move in y, down to 1.12 m, would lead
  // into the box.
  const std::vector<Vec2> way{{0.0, 1.0}, {4.0, 1.6}, {5.0, 1.0}};
  const std::vector<OrientedBox> box{{{2.5, 0.65, 0.0}, 2.0, 1.0}};
  const SmoothingOptions once{.data = 0.1, .smoothness = 0.4, .sweeps = 1};
  const SmoothingResult free = SmoothPath(way, {}, 0.1, {}, once);
  EXPECT_NEAR((free.path[1] - Vec2(2.8, 1.12)).norm(), 0.0, Tolerance(1e-12));
  const SmoothingResult held = SmoothPath(way, box, 0.1, {}, once);
  EXPECT_NEAR((held.path[1] - Vec2(2.8, 1.6)).norm(), 0.0, Tolerance(1e-12));
}

TEST(Smoothing, UniformWindChangesNothing) {
  const WindScoring windy{.wind = {.velocity = {7.0, -3.0}}, .speed = 3.0};
  EXPECT_EQ(SmoothPath(Stairs(), {}, 0.0, windy, {}).path,
            SmoothPath(Stairs(), {}, 0.0, {}, {}).path);
}

TEST(Smoothing, DoesNotGiveUpATailwind) {
  // Wind along +x blows only above y = 1.5 m. Smoothing without wind would move the upper points
  // down, out of the wind.
  const WindScoring windy{.wind = {.gusts = {{.velocity = {5.0, 0.0},
                                              .shape = GustShape::kStep,
                                              .area = OrientedBox{{5.0, 6.5, 0.0}, 20.0, 10.0}}}},
                          .speed = 3.0};
  const std::vector<Vec2> way{{0, 0}, {3, 2}, {6, 2}, {9, 0}};
  const SmoothingResult still = SmoothPath(way, {}, 0.0, {}, {.data = 0.1, .smoothness = 0.4});
  const SmoothingResult kept = SmoothPath(way, {}, 0.0, windy, {.data = 0.1, .smoothness = 0.4});
  EXPECT_LT(WindScore(still.path, windy), WindScore(way, windy) - 1.0);
  EXPECT_GE(WindScore(kept.path, windy), WindScore(way, windy) - 1e-6);
}

TEST(Smoothing, LeavesShortWaysAlone) {
  for (const std::vector<Vec2>& way :
       {std::vector<Vec2>{}, {Vec2(1.0, 2.0)}, {Vec2(1.0, 2.0), Vec2(3.0, 4.0)}}) {
    const SmoothingResult result = SmoothPath(way, {}, 0.0, {}, {});
    EXPECT_EQ(result.path, way);
    EXPECT_TRUE(result.converged);
  }
}

TEST(Smoothing, RefusesWhatDoesNotConverge) {
  EXPECT_THROW(SmoothPath(Stairs(), {}, 0.0, {}, {.data = 0.5, .smoothness = 0.25}), InternalError);
  EXPECT_THROW(SmoothPath(Stairs(), {}, 0.0, {}, {.data = 0.0, .smoothness = 0.0}), InternalError);
  EXPECT_THROW(SmoothPath(Stairs(), {}, 0.0, {.speed = 0.0}, {}), InternalError);
}

TEST(WindScore, IsWhatTheAirSpeedGainsToFirstOrder) {
  // The time T for a line dx at the air speed V satisfies V T = V |dx|/(V + w . t), with the wind w
  // and the unit vector t along the line. For a wind of V/1000, this time times V equals |dx| - W,
  // up to a millionth of |dx|, where W is the wind score.
  const WindScoring scoring{.wind = {.velocity = {0.01, 0.02}}, .speed = 20.0};
  const Vec2 from{3.0, 4.0};
  const Vec2 to{43.0, -10.0};
  const double length = (to - from).norm();
  const double along = scoring.wind.velocity.dot(to - from) / length;
  EXPECT_NEAR(20.0 * length / (20.0 + along), length - WindScore({from, to}, scoring),
              Tolerance(2e-6 * length));
}

TEST(WindScore, OfUniformWindDependsOnTheEndsAlone) {
  Random random(22);
  const WindScoring scoring{.wind = {.velocity = {4.0, -2.0}}, .speed = 3.0, .weight = 0.7};
  for (int i = 0; i < 20; ++i) {
    std::vector<Vec2> way = RandomWay(random, 9);
    const double direct = WindScore({way.front(), way.back()}, scoring);
    EXPECT_NEAR(WindScore(way, scoring), direct, Tolerance(1e-12 * 9.0 * 60.0));
    WindScoring against = scoring;
    against.wind.velocity = -scoring.wind.velocity;
    EXPECT_NEAR(WindScore(way, against), -direct, Tolerance(1e-12 * 9.0 * 60.0));
  }
  EXPECT_EQ(WindScore({}, scoring), 0.0);
  EXPECT_EQ(WindScore({Vec2(1.0, 1.0)}, scoring), 0.0);
}

TEST(WindScore, SeesAGustOnlyWhereAndWhenItBlows) {
  const WindScoring scoring{.wind = {.gusts = {{.velocity = {6.0, 0.0},
                                                .from = 2.0,
                                                .duration = 4.0,
                                                .area = OrientedBox{{5.0, 0.0, 0.0}, 10.0, 2.0}}}},
                            .time = 4.0,  // The gust is strongest at this time.
                            .speed = 3.0};
  EXPECT_NEAR(WindScore({{0, 0}, {10, 0}}, scoring), 20.0, Tolerance(1e-12));
  EXPECT_EQ(WindScore({{0, 5}, {10, 5}}, scoring), 0.0);
  WindScoring against = scoring;
  against.wind.gusts[0].velocity *= -1.0;
  EXPECT_NEAR(WindScore({{0, 0}, {10, 0}}, against), -20.0, Tolerance(1e-12));
  WindScoring before = scoring;
  before.time = 1.0;
  EXPECT_EQ(WindScore({{0, 0}, {10, 0}}, before), 0.0);
}

}  // namespace
}  // namespace trackbed
