#include "src/planning/sampling/prune_waypoints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"

namespace trackbed {
namespace {

/// Returns the tangent length of a corner, proportional to its turn. Any increasing function would
/// be suitable here.
double Tangent(double turn) {
  return 3.0 * turn;
}

struct Case {
  std::vector<Vec2> way;
  std::vector<OrientedBox> obstacles;
  WindScoring wind;
  double corner_cost = 0.0;
  std::optional<Vec2> before;
  bool first_leg = true;
  bool last_leg = true;

  [[nodiscard]] PruningProblem problem() const {
    return {.before = before,
            .first_leg = first_leg,
            .last_leg = last_leg,
            .obstacles = obstacles,
            .inflation = 0.5,
            .wind = wind,
            .corner_cost = corner_cost,
            .tangent = Tangent};
  }
};

/// Returns a random path around boxes, as a tree might return it. Some lines of the path may touch
/// boxes, which PruneWaypoints must tolerate.
Case RandomCase(Random& random) {
  Case one;
  const int points = 3 + random.Below(6);
  for (int i = 0; i < points; ++i) {
    one.way.emplace_back(4.0 * i, random.Uniform(-4.0, 4.0));
  }
  for (int i = 0; i < 3; ++i) {
    one.obstacles.push_back(
        {{random.Uniform(0.0, 30.0), random.Uniform(-4.0, 4.0), random.Uniform(-3.0, 3.0)},
         random.Uniform(0.5, 3.0),
         1.0});
  }
  one.corner_cost = random.Uniform(0.0, 4.0);
  if (random.Below(2) == 0) {
    one.wind = {.wind = {.gusts = {{.velocity = {2.0, 1.0},
                                    .shape = GustShape::kStep,
                                    .area = OrientedBox{{15.0, 3.0, 0.0}, 12.0, 6.0}}}},
                .speed = 3.0};
  }
  if (random.Below(2) == 0) {
    one.before = Vec2(-random.Uniform(1.0, 6.0), 0.0);
  }
  one.first_leg = random.Below(2) == 0;
  one.last_leg = random.Below(2) == 0;
  return one;
}

/// Returns the cost of a path by the documented formula. If a corner does not fit, its cost is a
/// million meters.
double PathCost(const Case& one, const std::vector<Vec2>& few) {
  double cost = -WindScore(InPieces(few), one.wind);
  std::vector<Vec2> all = few;
  if (one.before) {
    all.insert(all.begin(), *one.before);
  }
  for (std::size_t i = 1; i < few.size(); ++i) {
    cost += one.corner_cost + (few[i] - few[i - 1]).norm();
  }
  for (std::size_t i = 1; i + 1 < all.size(); ++i) {
    const Vec2 in = all[i] - all[i - 1];
    const Vec2 out = all[i + 1] - all[i];
    const bool all_in = i == 1 && one.first_leg;
    const bool all_out = i + 2 == all.size() && one.last_leg;
    const double turn = std::acos(std::clamp(in.normalized().dot(out.normalized()), -1.0, 1.0));
    const double room =
        std::min((all_in ? 1.0 : 0.5) * in.norm(), (all_out ? 1.0 : 0.5) * out.norm());
    cost += Tangent(turn) > room ? 1e6 : 0.0;
  }
  return cost;
}

/// Returns the lowest cost, found by enumerating all subsets of the points.
double LowestCost(const Case& one) {
  double cheapest = std::numeric_limits<double>::infinity();
  const std::size_t inner = one.way.size() - 2;
  for (std::size_t choice = 0; choice < (std::size_t{1} << inner); ++choice) {
    std::vector<Vec2> few{one.way.front()};
    std::size_t last = 0;
    bool free = true;
    for (std::size_t i = 1; i < one.way.size(); ++i) {
      if (i <= inner && (choice >> (i - 1) & 1U) == 0) {
        continue;
      }
      if (last + 1 < i) {
        for (const OrientedBox& box : one.obstacles) {
          free = free && Distance(few.back(), one.way[i], box) > 0.5;
        }
      }
      few.push_back(one.way[i]);
      last = i;
    }
    if (free) {
      cheapest = std::min(cheapest, PathCost(one, few));
    }
  }
  return cheapest;
}

TEST(FewCorners, AreTheCheapestOfAllChoices) {
  Random random(11);
  int fewer = 0;
  for (int i = 0; i < 500; ++i) {
    const Case one = RandomCase(random);
    const std::vector<Vec2> few = PruneWaypoints(one.way, one.problem());
    ASSERT_EQ(few.front(), one.way.front());
    ASSERT_EQ(few.back(), one.way.back());
    // The tolerance allows for rounding in sums of up to 1e7 m that are added in another order.
    ASSERT_NEAR(PathCost(one, few), LowestCost(one), Tolerance(1e-7)) << "case " << i;
    fewer += few.size() < one.way.size() ? 1 : 0;
  }
  EXPECT_GT(fewer, 300);
}

TEST(FewCorners, OfAStraightWayAreNone) {
  const Case one{.way = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {9, 0}}, .corner_cost = 1.0};
  EXPECT_EQ(PruneWaypoints(one.way, one.problem()), (std::vector<Vec2>{{0, 0}, {9, 0}}));
  const Case two{.way = {{0, 0}, {1, 5}}};
  EXPECT_EQ(PruneWaypoints(two.way, two.problem()), two.way);
}

TEST(FewCorners, OfALongWayAreFoundInWindows) {
  // A zigzag with an amplitude of 1 m through four windows. Within each window, one straight line
  // replaces the zigzag; successive windows share a point.
  Case one{.corner_cost = 1.0};
  for (std::size_t i = 0; i <= 4 * kPruningWindow; ++i) {
    one.way.emplace_back(static_cast<double>(i), i % 2 == 0 ? 0.0 : 1.0);
  }
  std::vector<Vec2> expected;
  for (std::size_t i = 0; i <= 4; ++i) {
    expected.push_back(one.way[i * kPruningWindow]);
  }
  EXPECT_EQ(PruneWaypoints(one.way, one.problem()), expected);
}

TEST(CloseCorners, BecomeOneCornerWhereTheirLegsMeet) {
  // Two corners of 0.46 rad need 1.4 m each, but are 1 m apart. Their legs meet at (10.5, 5.25).
  Case one{.way = {{0, 0}, {10, 5}, {11, 5}, {21, 0}},
           .obstacles = {{{10.5, 2.15, 0.0}, 1.0, 4.3}}};
  EXPECT_EQ(JoinCloseCorners(one.way, one.problem()),
            (std::vector<Vec2>{{0, 0}, {10.5, 5.25}, {21, 0}}));
  // An obstacle there leaves the corners as they are.
  one.obstacles.push_back({{10.5, 5.5, 0.0}, 0.2, 0.2});
  EXPECT_EQ(JoinCloseCorners(one.way, one.problem()), one.way);
}

TEST(CloseCorners, StayIfTheyFit) {
  const Case one{.way = {{0, 0}, {10, 5}, {20, 5}, {30, 0}}, .corner_cost = 5.0};
  EXPECT_EQ(JoinCloseCorners(one.way, one.problem()), one.way);
}

/// Returns a path around the round end of a wall, with corners on a circle of radius 2 m about the
/// wall's end. The path begins on one side of the wall and ends on the other side.
Case RoundAWallEnd(Random& random) {
  Case one;
  one.obstacles = {{{0.0, -10.0, 0.0}, 0.4, 20.0}};
  const double half = random.Uniform(0.3, 1.2);  // half of the turn [rad]
  const int corners = 2 + random.Below(4);
  const auto tangent_to = [&](double angle, double length) {
    const Vec2 radial(std::sin(angle), std::cos(angle));
    return Vec2(2.01 * radial + length * Vec2(radial.y(), -radial.x()));
  };
  one.way.push_back(tangent_to(-half, -random.Uniform(10.0, 20.0)));
  for (int i = 0; i < corners; ++i) {
    const double share = static_cast<double>(i) / (corners - 1);
    one.way.push_back(tangent_to(std::lerp(-half, half, share), 0.0));
  }
  one.way.push_back(tangent_to(half, random.Uniform(10.0, 20.0)));
  return one;
}

TEST(CloseCorners, FitAroundTheEndsOfWalls) {
  // The tangents at both ends of the arc meet at 2.01 tan(half) <= 5.2 m from it. A corner there
  // turns by at most 2.4 rad and needs 7.2 m of legs that are at least 10 m long.
  Random random(7);
  int joined = 0;
  for (int i = 0; i < 200; ++i) {
    const Case one = RoundAWallEnd(random);
    const std::vector<Vec2> few = JoinCloseCorners(one.way, one.problem());
    EXPECT_LT(PathCost(one, few), 1e6) << "case " << i;
    EXPECT_EQ(few.front(), one.way.front());
    EXPECT_EQ(few.back(), one.way.back());
    for (std::size_t k = 1; k < few.size(); ++k) {
      EXPECT_GT(Distance(few[k - 1], few[k], one.obstacles[0]), 0.5) << "case " << i;
    }
    joined += few == one.way ? 0 : 1;
  }
  EXPECT_GT(joined, 150);
}

TEST(CloseCorners, NeverCostMoreThanBefore) {
  Random random(12);
  int cheaper = 0;
  for (int i = 0; i < 500; ++i) {
    const Case one = RandomCase(random);
    const std::vector<Vec2> few = PruneWaypoints(one.way, one.problem());
    const std::vector<Vec2> joined = JoinCloseCorners(few, one.problem());
    // The tolerance allows for rounding in sums of up to 1e7 m that are added in another order.
    EXPECT_LE(PathCost(one, joined), PathCost(one, few) + Tolerance(1e-7)) << "case " << i;
    cheaper += PathCost(one, joined) < PathCost(one, few) - 1e5 ? 1 : 0;
  }
  EXPECT_GT(cheaper, 0);
}

TEST(InPieces, AreShortAndTheSameWay) {
  const std::vector<Vec2> way{{0.0, 0.0}, {2.5, 0.0}, {2.5, 0.5}};
  const std::vector<Vec2> pieces = InPieces(way);
  ASSERT_EQ(pieces.size(), 5U);
  EXPECT_NEAR(pieces[1].x(), 2.5 / 3.0, Tolerance(1e-12));
  EXPECT_EQ(pieces[3], way[1]);
  EXPECT_EQ(pieces[4], way[2]);
}

}  // namespace
}  // namespace trackbed
