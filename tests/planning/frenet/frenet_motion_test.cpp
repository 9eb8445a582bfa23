#include "trackbed/planning/frenet/frenet_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "tests/planning/frenet_scenes.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Returns a motion from 1 m left to 1.5 m right of the path within 5 s, during which the car
/// accelerates. For 2 s more, the car drives parallel to the path.
FrenetMotion Swerve() {
  FrenetPiece first{5.0, QuarticBetween({4.0, 5.0, 0.0}, {0.0, 7.0, 0.0}, 5.0),
                    QuinticBetween({1.0, 0.0, 0.0}, {-1.5, 0.0, 0.0}, 5.0)};
  FrenetPiece second{2.0, QuarticBetween({first.s.At(5.0), 7.0, 0.0}, {0.0, 7.0, 0.0}, 2.0),
                     Polynomial{{-1.5}}, true};
  return {{first, second}};
}

/// Returns a motion from rest at one offset to rest at another offset, 20 m farther along the path.
FrenetMotion FromRestToRest() {
  return {{{10.0, QuinticBetween({5.0, 0.0, 0.0}, {25.0, 0.0, 0.0}, 10.0),
            QuinticBetween({0.5, 0.0, 0.0}, {-0.5, 0.0, 0.0}, 20.0), true}}};
}

TEST(FrenetPiece, IsTheSameOverTimeAndOverStationAtConstantSpeed) {
  const Polynomial s{{3.0, 4.0}};
  const FrenetPiece over_time{5.0, s, QuinticBetween({1.0, 0.4, 0.2}, {-1.0, 0.0, 0.0}, 5.0)};
  // At the constant speed v = 4 m/s, the motion covers 20 m. The derivatives are d' = d_t/v and d''
  // = d_tt/v^2.
  const FrenetPiece over_station{5.0, s, QuinticBetween({1.0, 0.1, 0.0125}, {-1.0, 0.0, 0.0}, 20.0),
                                 true};
  for (double t = 0.0; t <= 5.0; t += 0.5) {
    const FrenetState a = over_time.At(t);
    const FrenetState b = over_station.At(t);
    EXPECT_EQ(a.s, b.s);
    EXPECT_NEAR(a.d, b.d, Tolerance(1e-13));
    EXPECT_NEAR(a.d_slope, b.d_slope, Tolerance(1e-13));
    EXPECT_NEAR(a.d_bend, b.d_bend, Tolerance(1e-13));
  }
}

TEST(FrenetMotion, GoesFromPieceToPiece) {
  const FrenetMotion motion = Swerve();
  EXPECT_EQ(motion.duration(), 7.0);
  EXPECT_EQ(motion.At(3.0), motion.pieces[0].At(3.0));
  EXPECT_EQ(motion.At(6.0), motion.pieces[1].At(1.0));
  EXPECT_EQ(motion.At(-1.0), motion.pieces[0].At(0.0));
  EXPECT_EQ(motion.At(9.0), motion.pieces[1].At(2.0));
  EXPECT_THROW(static_cast<void>(FrenetMotion{}.At(0.0)), InternalError);
}

TEST(Trajectory, HasPointsAsCloseAsAskedFor) {
  const auto points = SampleMotion(BentRoad(), Swerve(), 0.2, 0.1);
  ASSERT_TRUE(points);
  EXPECT_EQ(points->front().t, 0.0);
  EXPECT_NEAR(points->back().t, 7.0, Tolerance(1e-12));
  for (std::size_t i = 1; i < points->size(); ++i) {
    EXPECT_GT((*points)[i].t, (*points)[i - 1].t);
    // The samples may miss the time of the largest speed, so the distance between samples may be
    // larger by 1 %.
    EXPECT_LE((*points)[i].distance - (*points)[i - 1].distance, 0.101);
  }
  const auto few = SampleMotion(BentRoad(), Swerve(), 0.25, 100.0);
  ASSERT_TRUE(few);
  EXPECT_EQ(few->size(), 20U + 8U + 1U);
}

TEST(Trajectory, MeasuresTheDistanceDriven) {
  const Path path = BentRoad();
  for (const FrenetMotion& motion : {Swerve(), FromRestToRest()}) {
    const auto points = SampleMotion(path, motion, 0.2, 0.1);
    ASSERT_TRUE(points);
    double distance = 0.0;
    for (std::size_t i = 1; i < points->size(); ++i) {
      distance += boost::math::quadrature::gauss_kronrod<double, 15>::integrate(
          [&](double t) { return FromFrenet(path, motion.At(t))->speed; }, (*points)[i - 1].t,
          (*points)[i].t, 0);
      // The error is h^2/12 = 3e-5 s^2 times the jump of the acceleration at joints of the path,
      // 0.1 m/s^2.
      EXPECT_NEAR((*points)[i].distance, distance, Tolerance(1e-5));
    }
  }
}

/// Expects that the path of a reference stays on the motion from which the reference was computed,
/// at the points and between them.
void ExpectFollows(const Path& road, const FrenetMotion& motion) {
  const auto points = SampleMotion(road, motion, 0.2, 0.1);
  ASSERT_TRUE(points);
  const Reference reference = ToReference(*points);
  const auto dense = SampleMotion(road, motion, 0.01, 0.02);
  ASSERT_TRUE(dense);
  EXPECT_NEAR(reference.path.length(), dense->back().distance, Tolerance(1e-5));
  for (const TrajectoryPoint& point : *dense) {
    const PathPoint at = reference.path.At(point.distance);
    EXPECT_NEAR((at.pose.position() - point.motion.pose.position()).norm(), 0.0, Tolerance(1e-5));
    EXPECT_NEAR(at.pose.yaw, point.motion.pose.yaw, Tolerance(1e-5));
    EXPECT_EQ(at.direction, 1);
  }
  const auto& segments = reference.path.segments();
  for (std::size_t i = 1; i < segments.size(); ++i) {
    EXPECT_NEAR(segments[i - 1].CurvatureAt(segments[i - 1].length), segments[i].curvature,
                Tolerance(1e-12));
  }
}

TEST(Reference, FollowsTheMotion) {
  ExpectFollows(StraightRoad(), Swerve());
  ExpectFollows(BentRoad(), Swerve());
}

TEST(Reference, FollowsACarThatStartsAndStops) {
  ExpectFollows(BentRoad(), FromRestToRest());
}

TEST(Reference, IsAsFastAsTheMotion) {
  const auto points = SampleMotion(BentRoad(), Swerve(), 0.2, 0.1);
  ASSERT_TRUE(points);
  const Reference reference = ToReference(*points);
  for (const TrajectoryPoint& point : *points) {
    EXPECT_NEAR(reference.speed.SpeedAt(point.distance), point.motion.speed, Tolerance(1e-9));
    // The reference assumes a constant acceleration between points. The error is the sum of h^2/12
    // times the changes of the acceleration.
    EXPECT_NEAR(reference.speed.TimeAt(point.distance), point.t, Tolerance(1e-4));
  }
}

TEST(Reference, OfACarThatStaysIsAPoint) {
  const FrenetMotion stays{{{3.0, Polynomial{{5.0}}, Polynomial{{1.0}}, true}}};
  const auto points = SampleMotion(StraightRoad(), stays, 0.2, 0.1);
  ASSERT_TRUE(points);
  const Reference reference = ToReference(*points);
  EXPECT_EQ(reference.path.length(), 0.0);
  EXPECT_EQ(reference.path.At(0.0).pose, (Pose2{5.0, 1.0, 0.0}));
  EXPECT_EQ(reference.speed.SpeedAt(0.0), 0.0);
  EXPECT_THROW(ToReference({}), InternalError);
}

TEST(Trajectory, NeedsAFrameAllAlong) {
  const Path tight({0.0, 0.0, 0.0}, {{50.0, 0.2, 1}});
  const FrenetMotion beyond{{{3.0, Polynomial{{5.0, 3.0}}, Polynomial{{4.0, 0.0, 0.2}}}}};
  EXPECT_FALSE(SampleMotion(tight, beyond, 0.2, 0.1));
  // The offset d(t) cannot define the heading of a car at rest.
  const FrenetMotion stands{{{3.0, Polynomial{{5.0}}, Polynomial{{1.0, 0.1}}}}};
  EXPECT_FALSE(SampleMotion(StraightRoad(), stands, 0.2, 0.1));
}

}  // namespace
}  // namespace trackbed
