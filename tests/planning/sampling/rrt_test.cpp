#include "trackbed/planning/sampling/rrt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/case_names.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Returns a field with a wall across it that leaves a gap at the top.
RrtProblem Walled() {
  return {.start = {2.0, 5.0},
          .goal = {38.0, 5.0},
          .low = {0.0, 0.0},
          .high = {40.0, 30.0},
          .obstacles = {{{20.0, 11.0, 0.0}, 2.0, 24.0}, {{30.0, 20.0, 0.6}, 6.0, 3.0}},
          .inflation = 1.0};
}

/// Returns whether points every centimeter on an edge are farther than the inflation from all
/// obstacles.
bool IsFreeDensely(const Vec2& from, const Vec2& to, const RrtProblem& problem) {
  const int steps = 1 + static_cast<int>((to - from).norm() / 0.01);
  for (int i = 0; i <= steps; ++i) {
    const Vec2 p = from + (to - from) * (static_cast<double>(i) / steps);
    for (const OrientedBox& box : problem.obstacles) {
      const Vec2 own = ToLocal(box.center, p);
      const double dx = std::max(std::abs(own.x()) - 0.5 * box.length, 0.0);
      const double dy = std::max(std::abs(own.y()) - 0.5 * box.width, 0.0);
      if (std::hypot(dx, dy) <= problem.inflation.most) {
        return false;
      }
    }
  }
  return true;
}

double PathLength(const std::vector<Vec2>& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length += (path[i] - path[i - 1]).norm();
  }
  return length;
}

class RrtSeeds : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, RrtSeeds, testing::Range<std::uint64_t>(1, 21), kNamedByParameter);

TEST_P(RrtSeeds, LeadsFromStartToGoalOnFreeShortEdges) {
  const RrtProblem problem = Walled();
  const RrtOptions options;
  const RrtResult result = PlanRrt(problem, options, GetParam());
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.path.front(), problem.start);
  EXPECT_EQ(result.path.back(), problem.goal);
  EXPECT_NEAR(result.length, PathLength(result.path), Tolerance(1e-9));
  for (const RrtNode& node : result.nodes) {
    const Vec2& parent = result.nodes.at(node.parent).position;
    EXPECT_LE((node.position - parent).norm(), options.expand_distance + 1e-12);
    EXPECT_TRUE(IsFreeDensely(parent, node.position, problem));
  }
}

TEST_P(RrtSeeds, IsTheSameEveryTimeAndBeginsAlikeWithLess) {
  const RrtProblem problem = Walled();
  const RrtResult all = PlanRrt(problem, {}, GetParam());
  const RrtResult again = PlanRrt(problem, {}, GetParam());
  const RrtResult less = PlanRrt(problem, {.iterations = 40}, GetParam());
  ASSERT_EQ(all.nodes.size(), again.nodes.size());
  ASSERT_LE(less.nodes.size(), all.nodes.size());
  for (std::size_t i = 0; i < all.nodes.size(); ++i) {
    EXPECT_EQ(all.nodes[i].position, again.nodes[i].position);
    if (i < less.nodes.size()) {
      EXPECT_EQ(all.nodes[i].position, less.nodes[i].position);
    }
  }
}

TEST_P(RrtSeeds, GivesWhatItGotNearestWithWhenItsBudgetIsUsedUp) {
  RrtProblem problem = Walled();
  // Walls around the goal make it unreachable.
  for (const double side : {-1.0, 1.0}) {
    problem.obstacles.push_back({{38.0 + 3.0 * side, 5.0, 0.0}, 0.2, 6.2});
    problem.obstacles.push_back({{38.0, 5.0 + 3.0 * side, 0.0}, 6.2, 0.2});
  }
  const RrtResult result = PlanRrt(problem, {.iterations = 500}, GetParam());
  EXPECT_EQ(result.status, RrtStatus::kIterations);
  EXPECT_EQ(result.iterations, 500);
  ASSERT_FALSE(result.path.empty());
  const double reached = (result.path.back() - problem.goal).norm();
  for (const RrtNode& node : result.nodes) {
    EXPECT_GE((node.position - problem.goal).norm(), reached);
  }
}

TEST(Rrt, ChecksTheLastEdgeToTheGoalToo) {
  // A wall 10 cm thick stands between a start and a goal that are less than one step apart.
  const RrtProblem problem{.start = {0.0, 0.0},
                           .goal = {1.0, 0.0},
                           .low = {-2.0, -2.0},
                           .high = {3.0, 2.0},
                           .obstacles = {{{0.5, 0.0, 0.0}, 0.1, 10.0}},
                           .inflation = 0.1};
  const RrtResult result = PlanRrt(problem, {.iterations = 300}, 1);
  EXPECT_EQ(result.status, RrtStatus::kIterations);
}

TEST(Rrt, NeedsNoSampleWhereTheGoalIsInReach) {
  const RrtProblem problem{
      .start = {0.0, 0.0}, .goal = {1.0, 1.0}, .low = {0.0, 0.0}, .high = {1.0, 1.0}};
  const RrtResult result = PlanRrt(problem, {.iterations = 0}, 1);
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result.iterations, 0);
  EXPECT_THAT(result.path, testing::ElementsAre(problem.start, problem.goal));
  RrtProblem same = problem;
  same.goal = same.start;
  EXPECT_THAT(PlanRrt(same, {}, 1).path, testing::ElementsAre(problem.start));
}

TEST(Rrt, BlockedEndsAndNoBudgetAreStatuses) {
  RrtProblem problem = Walled();
  const RrtResult none = PlanRrt(problem, {.iterations = 0}, 1);
  EXPECT_EQ(none.status, RrtStatus::kIterations);
  EXPECT_THAT(none.path, testing::ElementsAre(problem.start));
  problem.start = {20.0, 5.0};
  EXPECT_EQ(PlanRrt(problem, {}, 1).status, RrtStatus::kStartBlocked);
  EXPECT_TRUE(PlanRrt(problem, {}, 1).path.empty());
  problem.start = {2.0, 5.0};
  problem.goal = {20.0, 23.5};  // within the wall's inflation
  EXPECT_EQ(PlanRrt(problem, {}, 1).status, RrtStatus::kGoalBlocked);
}

TEST(Rrt, EndsWhenItIsToldTo) {
  int asked = 0;
  const RrtOptions options{.stop = [&asked] { return ++asked > 7; }};
  const RrtResult result = PlanRrt(Walled(), options, 3);
  EXPECT_EQ(result.status, RrtStatus::kStopped);
  EXPECT_EQ(result.iterations, 7);
  EXPECT_FALSE(result.path.empty());
}

TEST(Rrt, RefusesWhatMakesNoSense) {
  RrtProblem problem = Walled();
  EXPECT_THROW(PlanRrt(problem, {.expand_distance = 0.0}, 1), InternalError);
  EXPECT_THROW(PlanRrt(problem, {.goal_bias = 1.5}, 1), InternalError);
  problem.goal = {50.0, 5.0};
  EXPECT_THROW(PlanRrt(problem, {}, 1), InternalError);
}

TEST(Rrt, NamesItsStatuses) {
  EXPECT_STREQ(ToString(RrtStatus::kReached), "reached");
  EXPECT_STREQ(ToString(RrtStatus::kGoalBlocked), "goal_blocked");
}

}  // namespace
}  // namespace trackbed
