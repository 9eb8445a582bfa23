#include "trackbed/path/path.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

// A few operations per segment on coordinates below 100 m.
constexpr double kRounding = 1e-12;

void ExpectPose(const Pose2& actual, const Pose2& expected, double tolerance = kRounding) {
  EXPECT_NEAR(actual.x, expected.x, Tolerance(tolerance));
  EXPECT_NEAR(actual.y, expected.y, Tolerance(tolerance));
  EXPECT_NEAR(actual.yaw, expected.yaw, Tolerance(tolerance));
}

/// 10 m east, a quarter circle of 10 m to the left, 10 m north.
Path Corner() {
  return {{}, {{10.0, 0.0, 1}, {5.0 * kPi, 0.1, 1}, {10.0, 0.0, 1}}};
}

// --- At
// --------------------------------------------------------------------------------------------

TEST(Path, PositiveCurvatureTurnsLeft) {
  ExpectPose(Corner().At(Corner().length()).pose, {20.0, 20.0, kPi / 2.0});
}

TEST(Path, DefaultIsAPointWithTangents) {
  const Path path;
  EXPECT_EQ(path.length(), 0.0);
  ExpectPose(path.At(0.0).pose, {});
  ExpectPose(path.At(3.0).pose, {3.0, 0.0, 0.0});
  ExpectPose(path.At(-3.0).pose, {-3.0, 0.0, 0.0});
}

TEST(Path, AtGivesPointsOfEachSegment) {
  const Path path = Corner();
  ExpectPose(path.At(4.0).pose, {4.0, 0.0, 0.0});
  ExpectPose(path.At(10.0 + 2.5 * kPi).pose,
             {10.0 + 10.0 * std::sin(kPi / 4.0), 10.0 - 10.0 * std::cos(kPi / 4.0), kPi / 4.0});
  ExpectPose(path.At(10.0 + 5.0 * kPi + 3.0).pose, {20.0, 13.0, kPi / 2.0});
  EXPECT_EQ(path.At(4.0).s, 4.0);
  EXPECT_NEAR(path.length(), 20.0 + 5.0 * kPi, Tolerance(kRounding));
}

TEST(Path, JointBelongsToTheSegmentThatBegins) {
  const Path path = Corner();
  EXPECT_EQ(path.At(0.0).curvature, 0.0);
  EXPECT_EQ(path.At(10.0).curvature, 0.1);
  EXPECT_EQ(path.At(std::nextafter(10.0, 0.0)).curvature, 0.0);
  EXPECT_EQ(path.At(10.0 + 5.0 * kPi).curvature, 0.0);
  const Path arc{{}, {{5.0, 0.1, 1}}};
  EXPECT_EQ(arc.At(5.0).curvature, 0.1);  // the end belongs to the last segment
}

TEST(Path, GoesOnAlongItsEndTangents) {
  const Path path{{1.0, 2.0, kPi / 2.0}, {{5.0 * kPi, 0.1, 1}}};
  const PathPoint before = path.At(-3.0);
  ExpectPose(before.pose, {1.0, -1.0, kPi / 2.0});
  EXPECT_EQ(before.curvature, 0.0);
  EXPECT_EQ(before.direction, 1);
  const PathPoint after = path.At(path.length() + 4.0);
  ExpectPose(after.pose, {-9.0 - 4.0, 12.0, kPi});
  EXPECT_EQ(after.curvature, 0.0);
}

TEST(Path, ReverseSegmentsRunAgainstTheHeading) {
  // Forwards 5 m, then back along a quarter circle to the left of 4 m, and straight back.
  const Path path{{}, {{5.0, 0.0, 1}, {2.0 * kPi, 0.25, -1}, {3.0, 0.0, -1}}};
  ExpectPose(path.At(5.0 + 2.0 * kPi).pose, {1.0, 4.0, -kPi / 2.0});
  ExpectPose(path.At(path.length()).pose, {1.0, 7.0, -kPi / 2.0});
  ExpectPose(path.At(path.length() + 2.0).pose, {1.0, 9.0, -kPi / 2.0});
  EXPECT_EQ(path.At(2.0).direction, 1);
  EXPECT_EQ(path.At(5.0).direction, -1);
  EXPECT_EQ(path.At(path.length() + 2.0).direction, -1);
  const Path back{{}, {{3.0, 0.0, -1}}};
  ExpectPose(back.At(-2.0).pose, {2.0, 0.0, 0.0});
}

TEST(Path, ClosesAfterTenKilometres) {
  // 140 laps round a square with rounded corners, 10 km: "below 1e-9 m over 10 km".
  std::vector<Segment> segments;
  for (int i = 0; i < 4 * 140; ++i) {
    segments.push_back({10.0, 0.0, 1});
    segments.push_back({5.0 * kPi / 2.0, 0.2, 1});
  }
  const Path path({5.0, 0.0, 0.0}, segments);
  EXPECT_GT(path.length(), 9990.0);
  EXPECT_NEAR((path.At(path.length()).pose.position() - Vec2{5.0, 0.0}).norm(), 0.0,
              Tolerance(1e-9));
  EXPECT_NEAR(path.At(path.length()).pose.yaw, 140.0 * 2.0 * kPi, Tolerance(1e-9));
}

TEST(Path, ChecksItsSegments) {
  EXPECT_THROW(Path({}, {{0.0, 0.0, 1}}), InternalError);
  EXPECT_THROW(Path({}, {{-1.0, 0.0, 1}}), InternalError);
  EXPECT_THROW(Path({}, {{std::nan(""), 0.0, 1}}), InternalError);
  EXPECT_THROW(Path({}, {{1.0, HUGE_VAL, 1}}), InternalError);
  EXPECT_THROW(Path({}, {{1.0, 0.0, 0}}), InternalError);
  EXPECT_THROW(Path({}, {{1.0, 0.0, 2}}), InternalError);
}

// --- Project
// -----------------------------------------------------------------------------------------

TEST(Project, LeftOfThePathIsPositive) {
  const Projection left = Corner().Project({4.0, 1.5, 0.25});
  EXPECT_NEAR(left.s, 4.0, Tolerance(kRounding));
  EXPECT_NEAR(left.cross_track, 1.5, Tolerance(kRounding));
  EXPECT_NEAR(left.heading_error, 0.25, Tolerance(kRounding));
  EXPECT_NEAR(Corner().Project({4.0, -1.5, 0.0}).cross_track, -1.5, Tolerance(kRounding));
}

TEST(Project, OnAnArcIsRadial) {
  // 2 m inside a left arc about (10, 10), at 30 deg: left of it.
  const Vec2 p = Vec2{10.0, 10.0} + 8.0 * Vec2{std::sin(kPi / 6.0), -std::cos(kPi / 6.0)};
  const Projection inside = Corner().Project({p.x(), p.y(), 0.0});
  EXPECT_NEAR(inside.s, 10.0 + 10.0 * kPi / 6.0, Tolerance(kRounding));
  EXPECT_NEAR(inside.cross_track, 2.0, Tolerance(kRounding));
  EXPECT_NEAR(inside.heading_error, -kPi / 6.0, Tolerance(kRounding));
}

TEST(Project, HeadingErrorIsWrapped) {
  EXPECT_NEAR(Corner().Project({4.0, 0.0, 2.0 * kPi + 0.1}).heading_error, 0.1,
              Tolerance(kRounding));
}

TEST(Project, ReachesBeyondBothEnds) {
  const Projection before = Corner().Project({-7.0, 1.0, 0.0});
  EXPECT_NEAR(before.s, -7.0, Tolerance(kRounding));
  EXPECT_NEAR(before.cross_track, 1.0, Tolerance(kRounding));
  const Projection after = Corner().Project({19.0, 26.0, kPi / 2.0});
  EXPECT_NEAR(after.s, Corner().length() + 6.0, Tolerance(kRounding));
  EXPECT_NEAR(after.cross_track, 1.0, Tolerance(kRounding));
}

TEST(Project, OnReverseSegmentsKeepsTheCarsLeft) {
  const Path path{{}, {{10.0, 0.0, -1}}};
  const Projection projection = path.Project({-4.0, 1.0, 0.1});
  EXPECT_NEAR(projection.s, 4.0, Tolerance(kRounding));
  EXPECT_NEAR(projection.cross_track, 1.0, Tolerance(kRounding));
  EXPECT_NEAR(projection.heading_error, 0.1, Tolerance(kRounding));
}

TEST(Project, WindowKeepsTheCarOnItsOwnSideOfACrossing) {
  // East through the origin, three quarters round to the left, south through the origin again.
  const Path path{{-20.0, 0.0, 0.0}, {{30.0, 0.0, 1}, {15.0 * kPi, 0.1, 1}, {40.0, 0.0, 1}}};
  const double second = 30.0 + 15.0 * kPi + 10.0;  // station of the second crossing
  ExpectPose(path.At(second).pose, {0.0, 0.0, 1.5 * kPi});
  const Pose2 car{0.05, 0.1, 0.0};  // nearer to the second branch
  EXPECT_NEAR(path.Project(car).s, second - 0.1, Tolerance(kRounding));
  EXPECT_NEAR(path.Project(car, {18.0, 23.0}).s, 20.05, Tolerance(kRounding));
  EXPECT_NEAR(path.Project(car, {18.0, 23.0}).cross_track, 0.1, Tolerance(kRounding));
}

TEST(Project, FigureEightIsFollowedAllTheWay) {
  // Two full circles through the origin. A car that is never more than 0.3 m off must not be seen
  // on the other one when it is looked for within 2 m of where it was.
  const Path path{{}, {{20.0 * kPi, 0.1, 1}, {20.0 * kPi, -0.1, 1}}};
  double last = 0.0;
  for (double s = 0.0; s < path.length(); s += 0.5) {
    const Pose2 pose = Compose(path.At(s).pose, {0.0, 0.3 * std::sin(s), 0.1});
    const Projection projection = path.Project(pose, {last - 2.0, last + 2.0});
    ASSERT_NEAR(projection.s, s, Tolerance(kRounding));
    ASSERT_NEAR(projection.cross_track, 0.3 * std::sin(s), Tolerance(kRounding));
    last = projection.s;
  }
}

TEST(Project, TiesGoToTheSmallestStation) {
  const Path path{{}, {{10.0, 0.0, 1}, {10.0, 0.0, -1}}};  // out and back
  EXPECT_NEAR(path.Project({4.0, 1.0, 0.0}).s, 4.0, Tolerance(kRounding));
  const Path laps{{}, {{60.0 * kPi, 0.1, 1}}};  // three times round
  EXPECT_NEAR(laps.Project({9.0, 10.0, 0.0}).s, 5.0 * kPi, Tolerance(kRounding));
  EXPECT_NEAR(laps.Project({9.0, 10.0, 0.0}, {40.0, 100.0}).s, 25.0 * kPi, Tolerance(kRounding));
}

TEST(Project, EndsOfTheWindowAreStations) {
  const Path path = Corner();
  EXPECT_EQ(path.Project({9.0, 0.0, 0.0}, {2.0, 5.0}).s, 5.0);
  EXPECT_EQ(path.Project({-9.0, 0.0, 0.0}, {2.0, 5.0}).s, 2.0);
  EXPECT_EQ(path.Project({4.0, 0.0, 0.0}, {7.0, 7.0}).s, 7.0);
  EXPECT_EQ(path.Project({4.0, 0.0, 0.0}, {-9.0, -8.0}).s, -8.0);
  EXPECT_EQ(path.Project({4.0, 0.0, 0.0}, {50.0, 60.0}).s, 50.0);
  EXPECT_THROW((void)path.Project({}, {1.0, 0.0}), InternalError);
}

TEST(Project, IsTheNearestOfAllPoints) {
  // Brute force: no point of a dense sampling may be nearer than the one that Project found.
  Random random(41);
  for (int i = 0; i < 300; ++i) {
    std::vector<Segment> segments;
    std::string text;
    const int count = random.Below(6);  // none as well
    for (int k = 0; k < count; ++k) {
      const double curvature = random.Below(3) == 0 ? 0.0 : random.Uniform(-0.3, 0.3);
      // Some arcs go round more than once.
      segments.push_back({random.Uniform(0.5, 40.0), curvature, random.Below(4) == 0 ? -1 : 1});
      text += fmt::format(" ({}, {}, {})", segments.back().length, curvature,
                          segments.back().direction);
    }
    const Path path(
        {random.Uniform(-5.0, 5.0), random.Uniform(-5.0, 5.0), random.Uniform(-4.0, 4.0)},
        segments);
    for (int j = 0; j < 10; ++j) {
      Pose2 car = path.At(random.Uniform(-10.0, path.length() + 10.0)).pose;
      car.x += random.Uniform(-8.0, 8.0);
      car.y += random.Uniform(-8.0, 8.0);
      Stations within;
      if (j % 2 == 1) {
        within.from = random.Uniform(-20.0, path.length() + 10.0);
        within.to = within.from + random.Uniform(0.0, 20.0);
      }
      SCOPED_TRACE(fmt::format("case {}.{}: car ({}, {}), within [{}, {}], segments{}", i, j, car.x,
                               car.y, within.from, within.to, text));
      const Projection projection = path.Project(car, within);
      ASSERT_GE(projection.s, within.from);
      ASSERT_LE(projection.s, within.to);
      const PathPoint foot = path.At(projection.s);
      const double nearest = (foot.pose.position() - car.position()).norm();
      const double from = std::max(within.from, -40.0);
      const double to = std::min(within.to, path.length() + 40.0);
      for (int step = 0; step <= 3000; ++step) {
        const double s = from + (to - from) * step / 3000.0;
        ASSERT_GE((path.At(s).pose.position() - car.position()).norm(), nearest - 1e-11)
            << "s = " << s << ", found " << projection.s;
      }
      // The cross-track error is the offset along the left of the path's point, and all of the
      // distance where the foot is not at an end.
      EXPECT_NEAR(projection.cross_track,
                  LeftOf(Direction(foot.pose.yaw)).dot(car.position() - foot.pose.position()),
                  Tolerance(kRounding));
      const double along = Direction(foot.pose.yaw).dot(car.position() - foot.pose.position());
      const double next = 1e-6;
      if (projection.s - next > within.from && projection.s + next < within.to &&
          path.At(projection.s - next).direction == path.At(projection.s + next).direction) {
        EXPECT_NEAR(along, 0.0, Tolerance(1e-10));
        EXPECT_NEAR(std::abs(projection.cross_track), nearest, Tolerance(1e-10));
      }
      EXPECT_NEAR(projection.heading_error, AngleDifference(car.yaw, foot.pose.yaw),
                  Tolerance(kRounding));
    }
  }
}

TEST(Project, OfAPathsOwnPointIsItsStation) {
  Random random(42);
  const Path path = Corner();
  for (int i = 0; i < 200; ++i) {
    const double s = random.Uniform(-10.0, path.length() + 10.0);
    const Projection projection = path.Project(path.At(s).pose);
    EXPECT_NEAR(projection.s, s, Tolerance(kRounding));
    EXPECT_NEAR(projection.cross_track, 0.0, Tolerance(kRounding));
    EXPECT_NEAR(projection.heading_error, 0.0, Tolerance(kRounding));
  }
}

// --- Sample
// ------------------------------------------------------------------------------------------

TEST(Sample, IsEvenAndHasBothEnds) {
  const Path path = Corner();
  for (const double spacing : {0.1, 0.7, 3.0, 1000.0}) {
    SCOPED_TRACE(spacing);
    const std::vector<PathPoint> points = path.Sample(spacing);
    ASSERT_GE(points.size(), 2U);
    EXPECT_EQ(points.front().s, 0.0);
    EXPECT_EQ(points.back().s, path.length());
    const double gap = path.length() / static_cast<double>(points.size() - 1);
    EXPECT_LE(gap, spacing);
    EXPECT_GT(path.length() / static_cast<double>(points.size() - 1) * 2.0,
              std::min(spacing, path.length()));
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      EXPECT_NEAR(points[i + 1].s - points[i].s, gap, Tolerance(kRounding));
      ExpectPose(points[i].pose, path.At(points[i].s).pose);
    }
  }
  EXPECT_THROW((void)path.Sample(0.0), InternalError);
}

}  // namespace
}  // namespace trackbed
