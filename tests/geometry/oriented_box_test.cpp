#include "trackbed/geometry/oriented_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/geometries/segment.hpp>
#include <cmath>
#include <limits>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"

// Tests distance, separation and swept distance of oriented boxes against Boost.Geometry and dense
// sampling.
namespace trackbed {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Polygon = bg::model::polygon<Point, false>;

// Rounding error [m] of a few operations on coordinates below 20 m, by Trackbed and by
// Boost.Geometry.
constexpr double kRounding = 1e-13;

Polygon Outline(const OrientedBox& box) {
  Polygon polygon;
  for (const Vec2& corner : box.Corners()) {
    bg::append(polygon, Point(corner.x(), corner.y()));
  }
  bg::correct(polygon);
  return polygon;
}

/// Returns Boost.Geometry's distance between two boxes, which is 0 if the boxes touch or overlap.
double ByBoost(const OrientedBox& a, const OrientedBox& b) {
  return bg::distance(Outline(a), Outline(b));
}
double ByBoost(const Vec2& from, const Vec2& to, const OrientedBox& box) {
  return bg::distance(bg::model::segment<Point>(Point(from.x(), from.y()), Point(to.x(), to.y())),
                      Outline(box));
}

bool Holds(const OrientedBox& outer, const OrientedBox& inner) {
  const auto corners = inner.Corners();
  return std::all_of(corners.begin(), corners.end(), [&](const Vec2& corner) {
    return bg::distance(Point(corner.x(), corner.y()), Outline(outer)) == 0.0;
  });
}

OrientedBox RandomBox(Random& random, double reach) {
  return {{random.Uniform(-reach, reach), random.Uniform(-reach, reach), random.Uniform(-4.0, 4.0)},
          random.Uniform(0.2, 8.0),
          random.Uniform(0.2, 8.0)};
}

OrientedBox Moved(const OrientedBox& box, const Vec2& by) {
  return {{box.center.x + by.x(), box.center.y + by.y(), box.center.yaw}, box.length, box.width};
}

TEST(OrientedBox, CornersGoRoundCounterClockwise) {
  const OrientedBox box{{1.0, 2.0, std::acos(-1.0) / 2.0}, 4.0, 2.0};
  const auto corners = box.Corners();
  // For a box that faces north, the front left corner lies north-west of the center.
  EXPECT_NEAR(corners[0].x(), 0.0, Tolerance(1e-12));
  EXPECT_NEAR(corners[0].y(), 4.0, Tolerance(1e-12));
  double area = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    area += 0.5 * Cross(corners[i], corners[(i + 1) % 4]);
  }
  EXPECT_NEAR(area, 8.0, Tolerance(1e-12));
}

TEST(Contains, IsTrueWithinAndOnTheBorder) {
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const OrientedBox box{
        {random.Uniform(-5.0, 5.0), random.Uniform(-5.0, 5.0), random.Uniform(-4.0, 4.0)},
        random.Uniform(0.1, 9.0),
        random.Uniform(0.1, 9.0)};
    const Vec2 p(random.Uniform(-6.0, 6.0), random.Uniform(-6.0, 6.0));
    EXPECT_EQ(Contains(box, p), bg::covered_by(Point(p.x(), p.y()), Outline(box)));
  }
  const OrientedBox box{{1.0, 2.0, 0.0}, 4.0, 2.0};
  EXPECT_TRUE(Contains(box, {3.0, 3.0}));
  EXPECT_FALSE(Contains(box, {3.0, 3.0000001}));
}

TEST(Distance, IsThatOfTheNearestSidesOrCorners) {
  const OrientedBox a{{0.0, 0.0, 0.0}, 2.0, 2.0};
  EXPECT_NEAR(Distance(a, {{5.0, 0.0, 0.0}, 2.0, 2.0}), 3.0, Tolerance(1e-12));
  EXPECT_NEAR(Distance(a, {{4.0, 5.0, 0.0}, 2.0, 2.0}), std::hypot(2.0, 3.0), Tolerance(1e-12));
  // A diamond whose corner points at the side of box `a`. The distance is 5 m - 1 m - sqrt(2) m.
  EXPECT_NEAR(Distance(a, {{5.0, 0.0, std::acos(-1.0) / 4.0}, 2.0, 2.0}), 4.0 - std::sqrt(2.0),
              Tolerance(1e-12));
}

TEST(Distance, IsZeroForOverlapTouchAndContainment) {
  const OrientedBox a{{0.0, 0.0, 0.3}, 4.0, 2.0};
  EXPECT_EQ(Distance(a, {{1.0, 0.5, 1.0}, 4.0, 2.0}), 0.0);
  EXPECT_EQ(Distance(a, {{0.0, 0.0, 0.0}, 0.1, 0.1}), 0.0);
  EXPECT_EQ(Distance({{0.0, 0.0, 0.0}, 0.1, 0.1}, a), 0.0);
  // The boxes cross each other, but no box contains a corner of the other box.
  EXPECT_EQ(Distance({{0.0, 0.0, 0.0}, 10.0, 0.1}, {{0.0, 0.0, 1.5}, 10.0, 0.1}), 0.0);
  EXPECT_EQ(Distance({{0.0, 0.0, 0.0}, 2.0, 2.0}, {{2.0, 0.0, 0.0}, 2.0, 2.0}), 0.0);
}

/// Returns the distance between two boxes outside each other, as the smallest distance from sampled
/// points on the outline of `a` to the outline of `b`.
double BySampling(const OrientedBox& a, const OrientedBox& b) {
  constexpr int kSamples = 200;
  double nearest = std::numeric_limits<double>::infinity();
  const auto ca = a.Corners();
  const auto cb = b.Corners();
  for (std::size_t i = 0; i < 4; ++i) {
    for (int u = 0; u < kSamples; ++u) {
      const Vec2 p = ca[i] + (ca[(i + 1) % 4] - ca[i]) * u / kSamples;
      for (std::size_t j = 0; j < 4; ++j) {
        const Vec2 along = cb[(j + 1) % 4] - cb[j];
        const double t = std::clamp((p - cb[j]).dot(along) / along.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (p - cb[j] - t * along).norm());
      }
    }
  }
  return nearest;
}

TEST(Distance, AgreesWithSampledOutlines) {
  Random random(7);
  int apart = 0;
  for (int i = 0; i < 200; ++i) {
    const OrientedBox a{{0.0, 0.0, random.Uniform(-3.0, 3.0)}, 4.0, 2.0};
    const OrientedBox b{
        {random.Uniform(-8.0, 8.0), random.Uniform(-8.0, 8.0), random.Uniform(-3.0, 3.0)},
        random.Uniform(0.5, 5.0),
        random.Uniform(0.5, 5.0)};
    const double exact = Distance(a, b);
    // Rounding of coordinates of about 10 m may change the distance if the boxes are exchanged.
    EXPECT_NEAR(exact, Distance(b, a), Tolerance(1e-13));
    if (exact > 0.0) {
      ++apart;
      // Sampling can only overestimate the distance, by at most half the spacing of the samples. On
      // the longer side of 4 m with 200 samples, this is 4/200/2 = 0.01 m.
      EXPECT_NEAR(BySampling(a, b), exact, Tolerance(0.01));
    }
  }
  EXPECT_GT(apart, 50);
}

TEST(Separation, OfBoxesApartIsBoostsDistance) {
  Random random(8);
  int apart = 0;
  for (int i = 0; i < 2000; ++i) {
    const OrientedBox a = RandomBox(random, 3.0);
    const OrientedBox b = RandomBox(random, 12.0);
    const double separation = Separation(a, b);
    EXPECT_EQ(separation > 0.0, ByBoost(a, b) > 0.0);
    EXPECT_EQ(Distance(a, b), std::max(separation, 0.0));
    EXPECT_NEAR(Separation(b, a), separation, Tolerance(kRounding));
    if (separation > 0.0) {
      ++apart;
      EXPECT_NEAR(separation, ByBoost(a, b), Tolerance(kRounding));
    }
  }
  EXPECT_GT(apart, 1000);
}

TEST(Separation, IsNegativeForContainmentAndCrossing) {
  // The room is 4 m x 3 m, and the box in its center is a square of 1 m. The shortest shift that
  // moves the box out of the room crosses a long side: 1.5 m + 0.5 m = 2 m.
  const OrientedBox room{{2.0, 1.0, 0.7}, 4.0, 3.0};
  EXPECT_NEAR(Separation(room, {{2.0, 1.0, 0.7}, 1.0, 1.0}), -2.0, Tolerance(kRounding));
  EXPECT_NEAR(Separation({{2.0, 1.0, 0.7}, 1.0, 1.0}, room), -2.0, Tolerance(kRounding));
  // The boxes form a cross; each bar is 10 m x 0.2 m. To separate the bars, one bar must move along
  // the other bar to its end, by (10 + 0.2)/2 = 5.1 m.
  EXPECT_NEAR(Separation({{0.0, 0.0, 0.2}, 10.0, 0.2}, {{0.0, 0.0, 0.2 + std::acos(0.0)}, 10, 0.2}),
              -5.1, Tolerance(kRounding));
  EXPECT_NEAR(Separation({{0.0, 0.0, 0.0}, 2.0, 2.0}, {{1.5, 0.5, 0.0}, 2.0, 2.0}), -0.5,
              Tolerance(kRounding));
  EXPECT_EQ(Separation({{0.0, 0.0, 0.0}, 2.0, 2.0}, {{2.0, 0.0, 0.0}, 2.0, 2.0}), 0.0);
}

TEST(Separation, OfOverlappingBoxesIsTheShortestWayOut) {
  Random random(9);
  int overlapping = 0;
  int contained = 0;
  for (int i = 0; i < 500; ++i) {
    const OrientedBox a = RandomBox(random, 1.0);
    const OrientedBox b = RandomBox(random, 3.0);
    const double depth = -Separation(a, b);
    if (depth <= 0.0) {
      continue;
    }
    SCOPED_TRACE(i);
    ++overlapping;
    contained += Holds(a, b) || Holds(b, a) ? 1 : 0;
    EXPECT_EQ(ByBoost(a, b), 0.0);
    // A shift of 1.001 times the depth along an axis of one box separates the boxes. A shift of
    // 0.99 times the depth separates the boxes in no direction.
    bool freed = false;
    for (const double yaw : {a.center.yaw, b.center.yaw}) {
      const Vec2 along = Direction(yaw);
      for (const Vec2& way : {along, Vec2(-along), LeftNormal(along), Vec2(-LeftNormal(along))}) {
        freed = freed || ByBoost(a, Moved(b, 1.001 * depth * way)) > 0.0;
        EXPECT_EQ(ByBoost(a, Moved(b, 0.99 * depth * way)), 0.0);
      }
    }
    EXPECT_TRUE(freed);
    for (int k = 0; k < 24; ++k) {
      EXPECT_EQ(ByBoost(a, Moved(b, 0.99 * depth * Direction(random.Uniform(-4.0, 4.0)))), 0.0);
    }
  }
  EXPECT_GT(overlapping, 200);
  EXPECT_GT(contained, 10);
}

TEST(Separation, ShrinksByWhatBoxesMoveTogether) {
  // Box `b` moves toward box `a` across the gap between two parallel sides, until the boxes
  // overlap.
  const OrientedBox a{{1.0, -2.0, 0.4}, 4.0, 2.0};
  for (double gap = 1.0; gap > -2.0; gap -= 0.125) {
    const OrientedBox b = Moved(a, (2.0 + gap) * LeftNormal(Direction(0.4)));
    EXPECT_NEAR(Separation(a, b), gap, Tolerance(kRounding));
  }
}

TEST(DistanceOfALine, IsBoosts) {
  Random random(10);
  int apart = 0;
  int across = 0;
  for (int i = 0; i < 4000; ++i) {
    const OrientedBox box = RandomBox(random, 3.0);
    const Vec2 from{random.Uniform(-10.0, 10.0), random.Uniform(-10.0, 10.0)};
    const Vec2 to{random.Uniform(-10.0, 10.0), random.Uniform(-10.0, 10.0)};
    const double distance = Distance(from, to, box);
    EXPECT_NEAR(distance, ByBoost(from, to, box), Tolerance(kRounding));
    EXPECT_NEAR(distance, Distance(to, from, box), Tolerance(kRounding));
    apart += distance > 0.0 ? 1 : 0;
    // The line crosses the box, and both ends of the line are outside the box.
    across +=
        distance == 0.0 && Distance(from, from, box) > 0.0 && Distance(to, to, box) > 0.0 ? 1 : 0;
  }
  EXPECT_GT(apart, 1000);
  EXPECT_GT(across, 300);
}

TEST(DistanceOfALine, OfAPointIsThatOfThePoint) {
  const OrientedBox box{{1.0, 2.0, std::acos(0.0)}, 4.0, 2.0};  // The box [0, 2] x [0, 4].
  const auto of_point = [&](const Vec2& p) { return Distance(p, p, box); };
  EXPECT_NEAR(of_point({5.0, 1.0}), 3.0, Tolerance(kRounding));
  EXPECT_NEAR(of_point({5.0, 8.0}), 5.0, Tolerance(kRounding));
  EXPECT_NEAR(of_point({1.0, -2.5}), 2.5, Tolerance(kRounding));
  EXPECT_EQ(of_point({1.0, 2.0}), 0.0);
  Random random(11);
  for (int i = 0; i < 500; ++i) {
    const OrientedBox any = RandomBox(random, 3.0);
    const Vec2 p{random.Uniform(-8.0, 8.0), random.Uniform(-8.0, 8.0)};
    EXPECT_NEAR(Distance(p, p, any), bg::distance(Point(p.x(), p.y()), Outline(any)),
                Tolerance(kRounding));
  }
}

TEST(DistanceOfALine, IsZeroWithinAcrossAndAtTheTouch) {
  const OrientedBox box{{0.0, 0.0, 0.0}, 4.0, 2.0};
  EXPECT_EQ(Distance({-1.0, 0.5}, {1.0, -0.5}, box), 0.0);  // inside
  EXPECT_EQ(Distance({-5.0, -3.0}, {5.0, 3.0}, box), 0.0);  // through the box, both ends outside
  EXPECT_EQ(Distance({-3.0, 0.0}, {3.0, 0.0}, box), 0.0);
  EXPECT_EQ(Distance({0.0, 0.0}, {9.0, 9.0}, box), 0.0);   // one end inside
  EXPECT_EQ(Distance({2.0, -5.0}, {2.0, 5.0}, box), 0.0);  // along a side
  EXPECT_EQ(Distance({1.0, 2.0}, {3.0, 0.0}, box), 0.0);   // through a corner
  // The line passes the corner (2, 1), although it overlaps the box's intervals in x and in y. The
  // distance from the corner to the line x + y = 4 is 1/sqrt(2).
  EXPECT_NEAR(Distance({1.0, 3.0}, {3.0, 1.0}, box), std::sqrt(0.5), Tolerance(kRounding));
}

TEST(Separation, IsNoNumberOfABoxThatIsNone) {
  const OrientedBox box{{1.0, 2.0, 0.3}, 3.0, 2.0};
  const double nan = std::nan("");
  for (const OrientedBox& other :
       {OrientedBox{{9.0, 0.0, nan}, 1.0, 1.0}, OrientedBox{{9.0, nan, 0.0}, 1.0, 1.0},
        OrientedBox{{9.0, 0.0, 0.0}, nan, 1.0}, OrientedBox{{9.0, 0.0, 0.0}, 1.0, nan}}) {
    EXPECT_TRUE(std::isnan(Separation(box, other)));
    EXPECT_TRUE(std::isnan(Distance(other, box)));
  }
}

TEST(MovingBox, GoesOnWithoutTurning) {
  const MovingBox box{{{1.0, 2.0, 0.5}, 4.0, 2.0}, {3.0, -1.0}};
  const OrientedBox later = box.At(2.0);
  EXPECT_EQ(later.center, (Pose2{7.0, 0.0, 0.5}));
  EXPECT_EQ(later.length, 4.0);
  EXPECT_EQ(later.width, 2.0);
  EXPECT_EQ(box.At(0.0).center, box.box.center);
}

}  // namespace
}  // namespace trackbed
