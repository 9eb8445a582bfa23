#include "trackbed/planning/sampling/rrt_star.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/geometries/segment.hpp>
#include <cmath>
#include <limits>
#include <queue>
#include <string>
#include <vector>

#include "tests/planning/maps.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"

// Tests RRT* on five maps. Boost.Geometry checks the edges and the costs. The test compares path
// lengths with the shortest path, which A* finds on a visibility graph.
namespace trackbed {

void PrintTo(const Map& map, std::ostream* out) {
  *out << map.name;
}

namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Polygon = bg::model::polygon<Point, false>;

/// The obstacles of a problem, with distances computed by Boost.Geometry.
class Surroundings {
 public:
  explicit Surroundings(const RrtStarProblem& problem) : inflation_(problem.inflation.most) {
    for (const OrientedBox& box : problem.obstacles) {
      Polygon& polygon = polygons_.emplace_back();
      for (const Vec2& corner : box.Corners()) {
        bg::append(polygon, Point(corner.x(), corner.y()));
      }
      bg::correct(polygon);
    }
  }

  [[nodiscard]] bool IsFree(const Vec2& p) const { return KeepsOff(Point(p.x(), p.y())); }
  [[nodiscard]] bool IsFree(const Vec2& from, const Vec2& to) const {
    return KeepsOff(bg::model::segment<Point>(Point(from.x(), from.y()), Point(to.x(), to.y())));
  }
  /// Returns whether points at most 1 cm apart on the line are free.
  [[nodiscard]] bool IsFreeBySamples(const Vec2& from, const Vec2& to) const {
    const double count = std::ceil((to - from).norm() / 0.01);
    for (double i = 0.0; i <= count; i += 1.0) {
      if (!IsFree(count == 0.0 ? from : Vec2(from + (to - from) * (i / count)))) {
        return false;
      }
    }
    return true;
  }

 private:
  template <typename Geometry>
  [[nodiscard]] bool KeepsOff(const Geometry& geometry) const {
    // Boost.Geometry may round a distance that is exactly at the limit.
    constexpr double kRounding = 1e-12;
    return std::all_of(polygons_.begin(), polygons_.end(), [&](const Polygon& polygon) {
      return bg::distance(geometry, polygon) > inflation_ - kRounding;
    });
  }

  double inflation_;
  std::vector<Polygon> polygons_;
};

/// Returns the length of the shortest path, at most 1e-4 too long. Runs A* on the visibility graph
/// of the start, the goal and points every 2 degrees around the corners of the boxes. The points
/// are on circles whose radius is the inflation divided by cos(1 degree), so that the chords
/// between the points are free. This makes the bends longer by the fraction 1.5e-4.
double ShortestWay(const RrtStarProblem& problem) {
  const Surroundings surroundings(problem);
  constexpr double kHalfStep = kPi / 180.0;
  const double radius = problem.inflation.most / std::cos(kHalfStep) * (1.0 + 1e-9);
  std::vector<Vec2> points{problem.start, problem.goal};
  for (const OrientedBox& box : problem.obstacles) {
    const auto corners = box.Corners();
    for (std::size_t i = 0; i < 4; ++i) {
      for (int k = 0; k < 45; ++k) {
        // The first corner of a box is its front left one.
        const double yaw =
            box.center.yaw + static_cast<double>(i) * kPi / 2.0 + (2 * k + 1) * kHalfStep;
        const Vec2 p = corners[i] + radius * Direction(yaw);
        if ((p.array() >= problem.low.array()).all() && (p.array() <= problem.high.array()).all() &&
            surroundings.IsFree(p)) {
          points.push_back(p);
        }
      }
    }
  }
  struct Reach {
    double estimate;
    double cost;
    std::size_t from;
    std::size_t to;
    bool operator>(const Reach& other) const { return estimate > other.estimate; }
  };
  std::priority_queue<Reach, std::vector<Reach>, std::greater<>> open;
  std::vector<bool> closed(points.size(), false);
  open.push({0.0, 0.0, 0, 0});
  while (!open.empty()) {
    const Reach reach = open.top();
    open.pop();
    if (closed[reach.to] || !surroundings.IsFree(points[reach.from], points[reach.to])) {
      continue;
    }
    if (reach.to == 1) {
      return reach.cost;
    }
    closed[reach.to] = true;
    for (std::size_t next = 0; next < points.size(); ++next) {
      if (!closed[next]) {
        const double cost = reach.cost + (points[next] - points[reach.to]).norm();
        open.push({cost + (problem.goal - points[next]).norm(), cost, reach.to, next});
      }
    }
  }
  return std::numeric_limits<double>::infinity();
}

double PolylineLength(const std::vector<Vec2>& way) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    length += (way[i] - way[i - 1]).norm();
  }
  return length;
}

RrtStarOptions Budget(int iterations) {
  RrtStarOptions options;
  options.iterations = iterations;
  return options;
}

/// Returns a problem in an empty area of 20 m x 10 m.
RrtStarProblem Nothing() {
  return {{2.0, 5.0}, {18.0, 5.0}, {0.0, 0.0}, {20.0, 10.0}, {}, 0.5};
}

bool SameTree(const RrtStarResult& a, const RrtStarResult& b) {
  return std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(),
                    [](const TreeNode& p, const TreeNode& q) {
                      return p.position == q.position && p.parent == q.parent && p.cost == q.cost;
                    });
}

// --- In every map
// -------------------------------------------------------------------------------------------

class RrtStarIn : public ::testing::TestWithParam<Map> {};

TEST_P(RrtStarIn, EdgesKeepFurtherOffThanTheInflation) {
  const RrtStarProblem& problem = GetParam().problem;
  const Surroundings surroundings(problem);
  const RrtStarResult result = PlanRrtStar(problem, Budget(2000), 3);
  ASSERT_GT(result.nodes.size(), 500U);
  for (const TreeNode& node : result.nodes) {
    const Vec2& parent = result.nodes[node.parent].position;
    ASSERT_TRUE(surroundings.IsFreeBySamples(parent, node.position))
        << "from " << parent.transpose() << " to " << node.position.transpose();
  }
}

TEST_P(RrtStarIn, CostsAreLengthsOfWaysFromTheStart) {
  const RrtStarProblem& problem = GetParam().problem;
  const RrtStarResult result = PlanRrtStar(problem, Budget(4000), 4);
  EXPECT_EQ(result.nodes[0].position, problem.start);
  EXPECT_EQ(result.nodes[0].parent, 0U);
  EXPECT_EQ(result.nodes[0].cost, 0.0);
  for (std::size_t i = 1; i < result.nodes.size(); ++i) {
    const TreeNode& node = result.nodes[i];
    const TreeNode& parent = result.nodes[node.parent];
    // The tolerance allows for the rounding error of one addition.
    ASSERT_NEAR(node.cost, parent.cost + (node.position - parent.position).norm(),
                Tolerance(1e-13));
    std::size_t steps = 0;
    for (std::size_t at = i; at != 0; at = result.nodes[at].parent) {
      ASSERT_LT(++steps, result.nodes.size()) << "node " << i << " hangs on itself";
    }
  }
}

TEST_P(RrtStarIn, PathIsAFreeWayOfTheTree) {
  const RrtStarProblem& problem = GetParam().problem;
  const RrtStarResult result = PlanRrtStar(problem, Budget(4000), 5);
  ASSERT_EQ(result.status, RrtStarStatus::kFound);
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result.iterations, 4000);
  EXPECT_EQ(result.path.front(), problem.start);
  EXPECT_EQ(result.path.back(), problem.goal);
  EXPECT_NEAR(result.cost, PolylineLength(result.path), Tolerance(1e-12));
  const Surroundings surroundings(problem);
  for (std::size_t i = 1; i < result.path.size(); ++i) {
    EXPECT_TRUE(surroundings.IsFreeBySamples(result.path[i - 1], result.path[i]));
  }
}

TEST_P(RrtStarIn, MoreIterationsGoOnFromFewer) {
  const RrtStarProblem& problem = GetParam().problem;
  RrtStarResult fewer = PlanRrtStar(problem, Budget(0), 6);
  for (const int iterations : {200, 400, 800, 1600, 3200, 6400}) {
    const RrtStarResult more = PlanRrtStar(problem, Budget(iterations), 6);
    EXPECT_LE(more.cost, fewer.cost);
    ASSERT_GE(more.nodes.size(), fewer.nodes.size());
    for (std::size_t i = 0; i < fewer.nodes.size(); ++i) {
      ASSERT_EQ(more.nodes[i].position, fewer.nodes[i].position);
      ASSERT_LE(more.nodes[i].cost, fewer.nodes[i].cost);
    }
    fewer = more;
  }
}

TEST_P(RrtStarIn, SameSeedSameTree) {
  const RrtStarProblem& problem = GetParam().problem;
  const RrtStarResult result = PlanRrtStar(problem, Budget(1000), 7);
  EXPECT_TRUE(SameTree(result, PlanRrtStar(problem, Budget(1000), 7)));
  EXPECT_FALSE(SameTree(result, PlanRrtStar(problem, Budget(1000), 8)));
}

TEST_P(RrtStarIn, GoalIsReachedFromNinetyNineOfAHundredSeeds) {
  int reached = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    reached += PlanRrtStar(GetParam().problem, Budget(2000), seed).ok() ? 1 : 0;
  }
  EXPECT_GE(reached, 99);
}

TEST_P(RrtStarIn, CostComesNearTheShortestWay) {
  const RrtStarProblem& problem = GetParam().problem;
  const double shortest = ShortestWay(problem);
  ASSERT_TRUE(std::isfinite(shortest));
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const double cost = PlanRrtStar(problem, Budget(20000), seed).cost;
    // No path is shorter than the shortest path, whose computed length is at most 1e-4 too long.
    EXPECT_GE(cost, shortest * (1.0 - Tolerance(1e-4)));
    EXPECT_LE(cost, shortest * (1.0 + Tolerance(0.03)));
  }
}

TEST_P(RrtStarIn, InformedItAddsOnlyWhatMayShortenThePath) {
  const RrtStarProblem& problem = GetParam().problem;
  RrtStarOptions options = Budget(1000);
  options.informed = true;
  RrtStarResult before = PlanRrtStar(problem, options, 9);
  ASSERT_TRUE(before.ok());
  for (const int iterations : {2000, 4000, 8000}) {
    options.iterations = iterations;
    const RrtStarResult after = PlanRrtStar(problem, options, 9);
    EXPECT_LE(after.cost, before.cost);
    for (std::size_t i = before.nodes.size(); i < after.nodes.size(); ++i) {
      const Vec2& p = after.nodes[i].position;
      ASSERT_LT((p - problem.start).norm() + (p - problem.goal).norm(), before.cost);
    }
    before = after;
  }
}

TEST_P(RrtStarIn, InformedItComesAsNearTheShortestWay) {
  const RrtStarProblem& problem = GetParam().problem;
  const double shortest = ShortestWay(problem);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    RrtStarOptions options = Budget(20000);
    options.informed = true;
    const double cost = PlanRrtStar(problem, options, seed).cost;
    // The bounds are those of CostComesNearTheShortestWay.
    EXPECT_GE(cost, shortest * (1.0 - Tolerance(1e-4)));
    EXPECT_LE(cost, shortest * (1.0 + Tolerance(0.03)));
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, RrtStarIn, ::testing::ValuesIn(Maps()),
                         [](const auto& test) { return test.param.name; });

// --- Ends
// -------------------------------------------------------------------------------------------

TEST(RrtStar, SaysWhichEndIsBlocked) {
  RrtStarProblem start = Nothing();
  start.obstacles = {Block(0.0, 4.0, 1.6, 6.0)};  // 0.4 m from the start
  const RrtStarResult result = PlanRrtStar(start, Budget(100), 1);
  EXPECT_EQ(result.status, RrtStarStatus::kStartBlocked);
  EXPECT_TRUE(result.path.empty());
  EXPECT_EQ(result.cost, std::numeric_limits<double>::infinity());
  EXPECT_EQ(result.iterations, 0);
  RrtStarProblem goal = Nothing();
  goal.obstacles = {Block(17.0, 4.0, 19.0, 6.0)};
  EXPECT_EQ(PlanRrtStar(goal, Budget(100), 1).status, RrtStarStatus::kGoalBlocked);
  // Points at a distance of exactly the inflation are blocked, because a path must keep a larger
  // distance.
  RrtStarProblem touching = Nothing();
  touching.obstacles = {Block(0.0, 4.0, 1.5, 6.0)};
  EXPECT_EQ(PlanRrtStar(touching, Budget(100), 1).status, RrtStarStatus::kStartBlocked);
  touching.obstacles = {Block(0.0, 4.0, 1.5 - 1e-9, 6.0)};
  EXPECT_EQ(PlanRrtStar(touching, Budget(100), 1).status, RrtStarStatus::kFound);
}

TEST(RrtStar, WithoutBudgetOrWayReachesNothing) {
  const RrtStarResult none = PlanRrtStar(Nothing(), Budget(0), 1);
  EXPECT_EQ(none.status, RrtStarStatus::kNotReached);
  EXPECT_EQ(none.iterations, 0);
  EXPECT_EQ(none.nodes.size(), 1U);
  RrtStarProblem closed = Nothing();
  closed.obstacles = {Block(9.0, -1.0, 10.0, 11.0)};
  const RrtStarResult result = PlanRrtStar(closed, Budget(2000), 1);
  EXPECT_EQ(result.status, RrtStarStatus::kNotReached);
  EXPECT_EQ(result.iterations, 2000);
  EXPECT_TRUE(result.path.empty());
  for (const TreeNode& node : result.nodes) {
    EXPECT_LT(node.position.x(), 8.5);
  }
}

TEST(RrtStar, InAnOpenFieldGoesStraight) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const RrtStarResult result = PlanRrtStar(Nothing(), Budget(2000), seed);
    ASSERT_TRUE(result.ok());
    // Intermediate nodes lie slightly off the straight line.
    EXPECT_GE(result.cost, 16.0 - Tolerance(1e-12));
    EXPECT_LE(result.cost, 16.0 * 1.01);
  }
}

TEST(RrtStar, InformedItLeavesOutMostOfAnOpenField) {
  RrtStarOptions options = Budget(2000);
  options.informed = true;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const RrtStarResult result = PlanRrtStar(Nothing(), options, seed);
    ASSERT_TRUE(result.ok());
    EXPECT_LE(result.cost, 16.0 * 1.01);
    // A path of 16.16 m between foci 16 m apart lies in an ellipse with semi-axes of 8.08 and 1.13
    // m. The ellipse covers 29 m^2 of 200 m^2, so it contains 290 of 2000 samples. The search added
    // further samples before the path was that short.
    EXPECT_LT(result.nodes.size(), 600U);
  }
}

TEST(RrtStar, SamplesALineToo) {
  RrtStarProblem problem;
  problem.goal = {30.0, 0.0};
  problem.low = {-5.0, 0.0};
  problem.high = {35.0, 0.0};
  const RrtStarResult result = PlanRrtStar(problem, {.iterations = 300, .step = 2.0}, 1);
  ASSERT_TRUE(result.ok());
  EXPECT_NEAR(result.cost, 30.0, Tolerance(1e-9));
  // The area is a single point.
  problem = {};
  EXPECT_EQ(PlanRrtStar(problem, {.iterations = 300}, 1).cost, 0.0);
}

TEST(RrtStar, GoalWithinAStepIsReachedAtOnce) {
  RrtStarProblem problem = Nothing();
  problem.goal = {4.0, 5.0};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const RrtStarResult result = PlanRrtStar(problem, Budget(20), seed);
    ASSERT_TRUE(result.ok());
    EXPECT_NEAR(result.cost, 2.0, Tolerance(1e-12));
    EXPECT_EQ(result.path, (std::vector<Vec2>{problem.start, problem.goal}));
  }
}

TEST(RrtStar, StartThatIsTheGoalIsAWayOfNoLength) {
  RrtStarProblem problem = Nothing();
  problem.goal = problem.start;
  for (const double bias : {0.0, 0.05, 1.0}) {
    RrtStarOptions options = Budget(1);
    options.goal_bias = bias;
    const RrtStarResult result = PlanRrtStar(problem, options, 1);
    ASSERT_TRUE(result.ok()) << bias;
    EXPECT_EQ(result.cost, 0.0);
  }
}

TEST(RrtStar, StepBoundsTheFirstEdges) {
  // If a new node has no neighbors, it is at most one step from an existing node.
  RrtStarOptions options = Budget(2000);
  options.step = 0.5;
  const RrtStarResult result = PlanRrtStar(Nothing(), options, 1);
  double furthest = 0.0;
  for (std::size_t i = 1; i < result.nodes.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < i; ++k) {
      nearest = std::min(nearest, (result.nodes[i].position - result.nodes[k].position).norm());
    }
    furthest = std::max(furthest, nearest);
  }
  // Each node was within one step of an existing node, up to rounding of its position.
  EXPECT_LE(furthest, 0.5 + Tolerance(1e-14));
  EXPECT_GT(furthest, 0.49);
}

TEST(RrtStar, StopsWhenAsked) {
  RrtStarOptions options = Budget(2000);
  int asked = 0;
  options.stop = [&] { return ++asked == 300; };
  const RrtStarResult stopped = PlanRrtStar(Nothing(), options, 1);
  EXPECT_EQ(stopped.iterations, 300);
  EXPECT_TRUE(SameTree(stopped, PlanRrtStar(Nothing(), Budget(300), 1)));
  EXPECT_TRUE(stopped.ok());  // The result is the best path so far.
}

TEST(RrtStar, ChecksItsProblemAndOptions) {
  RrtStarProblem outside = Nothing();
  outside.start.x() = -0.1;
  EXPECT_THROW(PlanRrtStar(outside, Budget(1), 1), InternalError);
  outside = Nothing();
  outside.goal.y() = 10.1;
  EXPECT_THROW(PlanRrtStar(outside, Budget(1), 1), InternalError);
  RrtStarProblem inflation = Nothing();
  inflation.inflation = -0.1;
  EXPECT_THROW(PlanRrtStar(inflation, Budget(1), 1), InternalError);
  EXPECT_THROW(PlanRrtStar(Nothing(), Budget(-1), 1), InternalError);
  for (const double bad : {-0.1, 1.1, std::nan("")}) {
    RrtStarOptions bias = Budget(1);
    bias.goal_bias = bad;
    EXPECT_THROW(PlanRrtStar(Nothing(), bias, 1), InternalError);
  }
  RrtStarOptions step = Budget(1);
  step.step = -1.0;
  EXPECT_THROW(PlanRrtStar(Nothing(), step, 1), InternalError);
}

TEST(RrtStar, StatusesHaveNames) {
  EXPECT_STREQ(ToString(RrtStarStatus::kFound), "found");
  EXPECT_STREQ(ToString(RrtStarStatus::kNotReached), "not_reached");
  EXPECT_STREQ(ToString(RrtStarStatus::kStartBlocked), "start_blocked");
  EXPECT_STREQ(ToString(RrtStarStatus::kGoalBlocked), "goal_blocked");
}

}  // namespace
}  // namespace trackbed
