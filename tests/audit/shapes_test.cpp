#include "tests/audit/shapes.h"

#include <gtest/gtest.h>

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>
#include <random>

namespace audit {
namespace {

namespace bg = boost::geometry;
using BoostPoint = bg::model::d2::point_xy<double>;
using BoostPolygon = bg::model::polygon<BoostPoint, false>;

BoostPolygon ToBoost(const Quad& quad) {
  BoostPolygon polygon;
  for (const Point& corner : quad) {
    bg::append(polygon.outer(), BoostPoint(corner.x, corner.y));
  }
  bg::correct(polygon);
  return polygon;
}

TEST(Gap, IsBoostsDistanceWhereBoostSeesOne) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> position(-3.0, 3.0), size(0.05, 3.0), yaw(-4.0, 4.0);
  int apart = 0, overlapping = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto quad = [&] {
      const double length = size(engine);
      return CornersAt({-0.3 * length, 0.7 * length, size(engine)},
                       {0.0, position(engine), position(engine), yaw(engine)});
    };
    const Quad a = quad();
    const Quad b = quad();
    const double distance = bg::distance(ToBoost(a), ToBoost(b));
    if (distance > 0.0) {
      ++apart;
      EXPECT_NEAR(Gap(a, b), distance, 1e-12);
    } else {
      ++overlapping;
      EXPECT_LE(Gap(a, b), 0.0);
    }
  }
  EXPECT_GT(apart, 500);
  EXPECT_GT(overlapping, 300);
}

TEST(Gap, IsMinusTheShortestWayOutWhereTheyOverlap) {
  const Quad a = CornersAt({-1.0, 1.0, 1.0}, {0.0, 0.0, 0.0, 0.0});
  const Quad b = CornersAt({-1.0, 1.0, 1.0}, {0.0, 1.7, 0.2, 0.0});
  EXPECT_NEAR(Gap(a, b), -0.3, 1e-12);
}

TEST(SweptGap, FindsABoxThatIsPassedBetweenTwoPoses) {
  const Box wall{{0.0, 5.0, 0.0, 0.0}, 0.1, 10.0, {}};
  const std::vector<TimedPose> poses{{0.0, 0.0, 0.0, 0.0}, {0.1, 10.0, 0.0, 0.0}};
  const Rectangle car{-0.5, 1.0, 1.0};
  EXPECT_LT(SweptGap(car, poses, wall, 1e-3).gap, -0.09);
  // A fast box passes the car at a distance of 0.25 m, and has left when the car arrives.
  const Box gone{{0.0, 5.0, 0.0, 0.0}, 0.1, 1.0, {0.0, 400.0}};
  EXPECT_GT(SweptGap(car, poses, gone, 1e-3).gap, 0.0);
}

TEST(SweptGap, IsThatOfTheMomentOfPassing) {
  // A post of 0.1 m, 2 m beside the path of a car 1 m wide: the gap is 1.5 m minus half of 0.1 m.
  const Box post{{0.0, 5.0, 2.0, 0.0}, 0.1, 0.1, {}};
  const std::vector<TimedPose> poses{{0.0, 0.0, 0.0, 0.0}, {1.0, 30.0, 0.0, 0.0}};
  const Nearest nearest = SweptGap({-0.5, 1.0, 1.0}, poses, post, 1e-3);
  EXPECT_NEAR(nearest.gap, 1.45, 1e-6);
  EXPECT_NEAR(nearest.step, 30.0, 1e-12);
}

TEST(Polyline, IsAsFarAsItsNearestSegmentOrEnd) {
  Polyline line({{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}});
  EXPECT_NEAR(line.DistanceTo({1.5, -0.5}), 0.5, 1e-12);
  EXPECT_NEAR(line.DistanceTo({-20.0, 0.0}), 20.0, 1e-12);
  EXPECT_NEAR(line.DistanceTo({5.0, 4.0}), 5.0, 1e-12);
  EXPECT_NEAR(line.LocalDistanceTo({1.5, -0.5}), 0.5, 1e-12);
}

}  // namespace
}  // namespace audit
