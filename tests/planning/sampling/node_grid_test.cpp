#include "src/planning/sampling/node_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <random>
#include <string>
#include <vector>

namespace trackbed {
namespace {

struct Box {
  std::string name;
  Vec2 low;
  Vec2 high;
};

void PrintTo(const Box& box, std::ostream* out) {
  *out << box.name;
}

/// A grid of random points in a box. The tests compare the results of queries with a linear search.
class NodeGridIn : public ::testing::TestWithParam<Box> {
 protected:
  Vec2 RandomPoint() {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const double x = share(random_);
    const double y = share(random_);
    return {std::lerp(GetParam().low.x(), GetParam().high.x(), x),
            std::lerp(GetParam().low.y(), GetParam().high.y(), y)};
  }

  void Add(const Vec2& point) {
    grid_.Add(point, points_.size());
    points_.push_back(point);
  }

  [[nodiscard]] std::vector<std::size_t> Within(const Vec2& p, double radius) const {
    std::vector<std::size_t> nodes;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if ((points_[i] - p).squaredNorm() <= radius * radius) {
        nodes.push_back(i);
      }
    }
    return nodes;
  }

  void ExpectTheSameAsOneByOne(const Vec2& p, double radius) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec2& point : points_) {
      nearest = std::min(nearest, (point - p).squaredNorm());
    }
    EXPECT_EQ((points_[grid_.Nearest(p)] - p).squaredNorm(), nearest);
    std::vector<NodeGrid::Near> near{{1.0, 2}};  // A result of an earlier query.
    grid_.FindWithin(p, radius, near);
    std::vector<std::size_t> nodes;
    for (const NodeGrid::Near& found : near) {
      nodes.push_back(found.node);
      EXPECT_EQ(found.square, (points_[found.node] - p).squaredNorm());
    }
    std::sort(nodes.begin(), nodes.end());
    EXPECT_EQ(nodes, Within(p, radius));
  }

  std::mt19937_64 random_{3};
  NodeGrid grid_{GetParam().low, GetParam().high};
  std::vector<Vec2> points_;
};

TEST_P(NodeGridIn, FindsWhatALookAtAllPointsFinds) {
  const double size = std::max((GetParam().high - GetParam().low).norm(), 1.0);
  for (int i = 0; i < 3000; ++i) {
    Add(RandomPoint());
    if (i < 40 || i % 50 == 0) {
      for (const double share : {0.0, 0.03, 0.2, 2.0}) {
        ExpectTheSameAsOneByOne(RandomPoint(), share * size);
      }
    }
  }
}

TEST_P(NodeGridIn, FindsNodesThatAllLieInOneCorner) {
  const Vec2 size = GetParam().high - GetParam().low;
  for (int i = 0; i < 1000; ++i) {
    Add(GetParam().low + 0.01 * (RandomPoint() - GetParam().low));
  }
  ExpectTheSameAsOneByOne(GetParam().high, 0.995 * size.norm());
  ExpectTheSameAsOneByOne(GetParam().low, 0.005 * size.norm());
}

INSTANTIATE_TEST_SUITE_P(Boxes, NodeGridIn,
                         ::testing::Values(Box{"Square", {-10.0, -10.0}, {10.0, 10.0}},
                                           Box{"Long", {1000.0, 5.0}, {3000.0, 7.5}},
                                           Box{"Thin", {0.0, 0.0}, {1e-6, 100.0}},
                                           Box{"Line", {-5.0, 2.0}, {35.0, 2.0}},
                                           Box{"Point", {4.0, 4.0}, {4.0, 4.0}}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace trackbed
