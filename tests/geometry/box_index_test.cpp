#include "trackbed/geometry/box_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<OrientedBox> RandomBoxes(Random& random, int count) {
  std::vector<OrientedBox> boxes;
  for (int i = 0; i < count; ++i) {
    boxes.push_back(
        {{random.Uniform(-100.0, 100.0), random.Uniform(-100.0, 100.0), random.Uniform(-4.0, 4.0)},
         random.Uniform(0.01, 20.0),
         random.Uniform(0.01, 2.0)});
  }
  return boxes;
}

/// Numbers of boxes. BoxIndex uses a linear search up to 16 boxes, and a tree for more boxes.
constexpr std::array kCounts{0, 1, 16, 17, 400};

TEST(BoxIndex, TellsTheSameDistanceAsLookingAtAllBoxes) {
  Random random(7);
  for (const int count : kCounts) {
    const BoxIndex index(RandomBoxes(random, count));
    for (int i = 0; i < 500; ++i) {
      const OrientedBox asked = RandomBoxes(random, 1).front();
      double nearest = kInfinity;
      for (const OrientedBox& box : index.boxes()) {
        nearest = std::min(nearest, Distance(asked, box));
      }
      EXPECT_EQ(index.DistanceTo(asked), nearest) << count;
      EXPECT_EQ(index.DistanceTo(asked, 3.0), std::min(nearest, 3.0)) << count;
    }
  }
}

TEST(BoxIndex, TellsTheSameOfLinesAsLookingAtAllBoxes) {
  Random random(8);
  for (const int count : kCounts) {
    const BoxIndex index(RandomBoxes(random, count));
    int kept = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec2 from{random.Uniform(-110.0, 110.0), random.Uniform(-110.0, 110.0)};
      const Vec2 to = from + Vec2{random.Uniform(-9.0, 9.0), random.Uniform(-9.0, 9.0)};
      const double distance = random.Uniform(0.0, 3.0);
      const bool keeps =
          std::all_of(index.boxes().begin(), index.boxes().end(),
                      [&](const OrientedBox& box) { return Distance(from, to, box) > distance; });
      EXPECT_EQ(index.KeepsFrom(from, to, distance), keeps) << count;
      kept += keeps ? 1 : 0;
    }
    EXPECT_GT(kept, 0) << count;
    EXPECT_TRUE(count < 400 || kept < 500);
  }
}

TEST(BoxIndex, CountsTouchingAsNotKept) {
  std::vector<OrientedBox> row;
  for (int i = 0; i < 20; ++i) {
    row.push_back({{10.0 * i, 0.0, 0.0}, 2.0, 2.0});
  }
  const BoxIndex index(row);
  EXPECT_FALSE(index.KeepsFrom({-5.0, 3.0}, {5.0, 3.0}, 2.0));
  EXPECT_TRUE(index.KeepsFrom({-5.0, 3.0}, {5.0, 3.0}, 1.9999999));
  EXPECT_EQ(index.DistanceTo({{0.0, 2.0, 0.0}, 2.0, 2.0}), 0.0);
}

TEST(BoxIndex, RefusesWhatIsNotFinite) {
  const OrientedBox nowhere{{std::nan(""), 0.0, 0.0}, 1.0, 1.0};
  EXPECT_THROW(BoxIndex({nowhere}), PreconditionError);
  EXPECT_THROW(BoxIndex(std::vector<OrientedBox>(20, nowhere)), PreconditionError);
  EXPECT_TRUE(std::isnan(BoxIndex({{{}, 1.0, 1.0}}).DistanceTo(nowhere)));
}

TEST(Inflation, FreesPointsNearRectangles) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    std::vector<OrientedBox> boxes;
    for (int k = 0; k < 20; ++k) {
      boxes.push_back(
          {{random.Uniform(-10.0, 10.0), random.Uniform(-10.0, 10.0), random.Uniform(-3.0, 3.0)},
           random.Uniform(0.1, 2.0),
           random.Uniform(0.1, 2.0)});
    }
    const std::vector<Vec2> points{{random.Uniform(-9.0, 9.0), random.Uniform(-9.0, 9.0)},
                                   {random.Uniform(-9.0, 9.0), random.Uniform(-9.0, 9.0)}};
    constexpr double kMost = 1.5;
    const Inflation inflation = InflationAt(points, boxes, kMost);
    const BoxIndex index(boxes);
    for (const Vec2& point : points) {
      const bool is_inside = std::any_of(boxes.begin(), boxes.end(), [&](const OrientedBox& box) {
        return Distance(point, point, box) == 0.0;
      });
      EXPECT_EQ(index.KeepsFrom(point, point, inflation), !is_inside);
    }
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      const double nearest = std::min(Distance(points[0], points[0], boxes[k]),
                                      Distance(points[1], points[1], boxes[k]));
      // The inflation is reduced by a nanometer, for rounding.
      EXPECT_NEAR(inflation.From(k), std::min(nearest, kMost), Tolerance(1.01e-9));
      EXPECT_LE(inflation.From(k), kMost);
    }
  }
  EXPECT_TRUE(InflationAt({{0.0, 0.0}}, {{{5.0, 0.0, 0.0}, 1.0, 1.0}}, 2.0).own.empty());
}

}  // namespace
}  // namespace trackbed
