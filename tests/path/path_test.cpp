#include "trackbed/path/path.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/support/expect_near.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

// Tests Path: evaluation against closed forms of lines, arcs and clothoids, projection against a
// search over many points, sampling, cutting, and SegmentsThrough on a curve with known curvature.
namespace trackbed {
namespace path_test {

// Rounding error [m] of a few operations per segment on coordinates below 100 m.
constexpr double kRounding = 1e-12;

void ExpectPose(const Pose2& actual, const Pose2& expected, double tolerance = kRounding) {
  ExpectNear(actual, expected, tolerance);
}

/// Returns a path of 10 m to the east, a quarter circle of radius 10 m to the left, and 10 m to the
/// north.
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
  EXPECT_EQ(arc.At(5.0).curvature, 0.1);  // The end of the path belongs to the last segment.
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
  // The car drives 5 m forward. Then the car reverses along a quarter circle of radius 4 m with its
  // wheels turned left, and 3 m straight.
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

TEST(Path, BendsAsItsPointsDo) {
  const Path path({1.0, 2.0, 0.5},
                  {{3.0, 0.1}, {2.0, -0.2, 1, 0.05, 0.01}, {4.0, 0.3, -1}, {1.0, 0.0, -1}});
  for (double s = -2.0; s < 12.0; s += 0.25) {
    const PathPoint point = path.At(s);
    const PathBend bend = path.BendAt(s);
    EXPECT_EQ(bend.curvature, point.curvature) << s;
    EXPECT_EQ(bend.direction, point.direction) << s;
  }
  EXPECT_EQ(Path().BendAt(1.0).direction, 1);
}

TEST(Path, ClosesAfterTenKilometers) {
  // The path leads 140 times around a square with rounded corners, over 10 km in total. The
  // documentation of Path states an error below 1e-9 m over 10 km.
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
  EXPECT_THROW(Path({0.0, std::nan(""), 0.0}, {}), PreconditionError);
  EXPECT_THROW(Path({0.0, 0.0, HUGE_VAL}, {{1.0, 0.0, 1}}), PreconditionError);
  // Numerical integration of a clothoid whose heading changes by 10^20 rad would take years, so
  // Path rejects such a segment. An arc has a closed form.
  EXPECT_THROW(Path({}, {{1e10, 0.0, 1, 1.0}}), PreconditionError);
  EXPECT_THROW(Path({}, {{1e254, 0.0, 1, 1e-300}}), PreconditionError);
  EXPECT_NO_THROW(Path({}, {{1e10, 1e10, 1}}));
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
  // The car is 2 m inside of the left arc around (10, 10), at 30 degrees along the arc. The inside
  // is the left side.
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
  // The path leads east through the origin, along three quarters of a circle to the left, and south
  // through the origin.
  const Path path{{-20.0, 0.0, 0.0}, {{30.0, 0.0, 1}, {15.0 * kPi, 0.1, 1}, {40.0, 0.0, 1}}};
  const double second = 30.0 + 15.0 * kPi + 10.0;  // Station of the second passage through the
                                                   // origin.
  ExpectPose(path.At(second).pose, {0.0, 0.0, 1.5 * kPi});
  const Pose2 car{0.05, 0.1, 0.0};  // The car is nearer to the second branch of the path.
  EXPECT_NEAR(path.Project(car).s, second - 0.1, Tolerance(kRounding));
  EXPECT_NEAR(path.Project(car, {18.0, 23.0}).s, 20.05, Tolerance(kRounding));
  EXPECT_NEAR(path.Project(car, {18.0, 23.0}).cross_track, 0.1, Tolerance(kRounding));
}

TEST(Project, FigureEightIsFollowedAllTheWay) {
  // The path consists of two full circles through the origin. A car stays within 0.3 m of the path,
  // and the search covers 2 m around its last station. Project must not return a point on the other
  // circle.
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
  const Path path{{}, {{10.0, 0.0, 1}, {10.0, 0.0, -1}}};  // The path leads forward and back over
                                                           // the same points.
  EXPECT_NEAR(path.Project({4.0, 1.0, 0.0}).s, 4.0, Tolerance(kRounding));
  const Path laps{{}, {{60.0 * kPi, 0.1, 1}}};  // Three laps of a circle.
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
  EXPECT_THROW((void)path.Project({0.0, std::nan(""), 0.0}), PreconditionError);
}

TEST(Project, IsTheNearestOfAllPoints) {
  // No point of a dense sampling may be nearer than the projection.
  Random random(41);
  for (int i = 0; i < 300; ++i) {
    std::vector<Segment> segments;
    std::string text;
    const int count = random.Below(6);  // A path may have no segments.
    for (int k = 0; k < count; ++k) {
      const double curvature = random.Below(3) == 0 ? 0.0 : random.Uniform(-0.3, 0.3);
      // Some arcs cover more than a full circle.
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
      // The cross-track error is the offset along the left normal at the projected point. Its
      // absolute value is the distance, unless the projected point is an end of the search interval
      // or a cusp.
      EXPECT_NEAR(projection.cross_track,
                  LeftNormal(Direction(foot.pose.yaw)).dot(car.position() - foot.pose.position()),
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
  EXPECT_THROW((void)path.Sample(1e-300), PreconditionError);
}

// --- Segments of changing curvature
// ------------------------------------------------------------------------------------------

/// Integrates `f` over [0, length] by Simpson's rule with an even number of intervals.
template <typename Function>
double Simpson(const Function& f, double length, int intervals) {
  const double h = length / intervals;
  double sum = f(0.0) + f(length);
  for (int i = 1; i < intervals; ++i) {
    sum += (i % 2 == 1 ? 4.0 : 2.0) * f(h * i);
  }
  return sum * h / 3.0;
}

/// Returns the end of the clothoid with curvature kappa(d) = sharpness d that starts at the origin.
/// Sums the power series of the Fresnel integrals, i^n (sharpness/2)^n length^(2n+1)/(n! (2n+1)).
Vec2 FresnelEnd(double sharpness, double length) {
  const double turned = 0.5 * sharpness * length * length;
  Vec2 end{0.0, 0.0};
  double power = length;  // The value of length x turned^n/n!.
  for (int n = 0; n < 60; ++n) {
    end[n % 2] += (n % 4 < 2 ? 1.0 : -1.0) * power / (2 * n + 1);
    power *= turned / (n + 1);
  }
  return end;
}

TEST(Clothoid, EndsWhereTheFresnelIntegralsDo) {
  for (const double sharpness : {-0.05, -0.004, 1e-6, 0.01, 0.03}) {
    for (const double length : {0.5, 8.0, 15.0}) {
      SCOPED_TRACE(fmt::format("sharpness {}, length {}", sharpness, length));
      const double turned = 0.5 * sharpness * length * length;
      const Vec2 end = FresnelEnd(sharpness, length);
      // The terms of the series are below length e^turned, so their rounding error is at most 15
      // e^6 1e-16 m = 6e-13 m.
      const Path forward{{}, {{length, 0.0, 1, sharpness}}};
      ExpectPose(forward.At(length).pose, {end.x(), end.y(), turned}, kRounding);
      // In reverse, the same curvature turns the car to the other side, so the end is the mirror
      // image.
      const Path back{{}, {{length, 0.0, -1, sharpness}}};
      ExpectPose(back.At(length).pose, {-end.x(), end.y(), -turned}, kRounding);
    }
  }
}

/// Returns a random segment whose curvature at both ends is within a car's limits. In half of the
/// segments, the curvature has a bulge between the ends.
Segment RandomSegment(Random& random) {
  const double length = random.Uniform(0.5, 20.0);
  const double from = random.Uniform(-0.2, 0.2);
  const double to = random.Uniform(-0.2, 0.2);
  const double bulge = random.Below(2) == 0 ? 0.0 : random.Uniform(-0.1, 0.1);
  // The curvature at the distance d is from + (to - from) t + 4 bulge t (1 - t), with t = d/length.
  return {length, from, random.Below(3) == 0 ? -1 : 1, (to - from + 4.0 * bulge) / length,
          -8.0 * bulge / (length * length)};
}

TEST(QuadraticSegment, EndsWhereItsHeadingLeads) {
  Random random(51);
  for (int i = 0; i < 100; ++i) {
    const Segment segment = RandomSegment(random);
    const Pose2 start{random.Uniform(-5.0, 5.0), random.Uniform(-5.0, 5.0),
                      random.Uniform(-4.0, 4.0)};
    const auto yaw = [&](double d) {
      return start.yaw +
             segment.direction * (segment.curvature * d + segment.sharpness * d * d / 2 +
                                  segment.sharpness_rate * d * d * d / 6);
    };
    // With respect to t = d/length, the fourth derivatives of the cosine and the sine of the
    // heading are below 4000. With 4000 intervals, the error of Simpson's rule is below 20 m x
    // 4000/180/4000^4 = 2e-12 m.
    const auto x = [&](double d) { return std::cos(yaw(d)); };
    const auto y = [&](double d) { return std::sin(yaw(d)); };
    const Path path(start, {segment});
    ExpectPose(
        path.At(segment.length).pose,
        {start.x + segment.direction * Simpson(x, segment.length, 4000),
         start.y + segment.direction * Simpson(y, segment.length, 4000), yaw(segment.length)},
        3e-12);
  }
}

TEST(QuadraticSegment, DrivenBackEndsAtItsStart) {
  Random random(52);
  for (int i = 0; i < 100; ++i) {
    const Segment out = RandomSegment(random);
    const Segment back{out.length, out.CurvatureAt(out.length), -out.direction,
                       -(out.sharpness + out.length * out.sharpness_rate), out.sharpness_rate};
    const Path both({1.0, 2.0, 0.5}, {out, back});
    ExpectPose(both.At(both.length()).pose, {1.0, 2.0, 0.5});
    const double part = 0.3 * out.length;
    ExpectPose(both.At(both.length() - part).pose, both.At(part).pose);
  }
}

TEST(QuadraticSegment, DerivativesAreThoseOfItsPoints) {
  Random random(53);
  for (int i = 0; i < 200; ++i) {
    const Segment segment = RandomSegment(random);
    const Path path({}, {segment});
    constexpr double kStep = 1e-4;
    const double s = random.Uniform(kStep, segment.length - kStep);
    const PathPoint before = path.At(s - kStep);
    const PathPoint at = path.At(s);
    const PathPoint after = path.At(s + kStep);
    // The error of a central difference is h^2/6 times the third derivative. For the shortest
    // segments, the third derivative is (0.3^2 + 1.6) 1/m^2 for the position and 3.2 1/m^3 for the
    // heading. Rounding adds 1e-15/h.
    const Vec2 tangent = (after.pose.position() - before.pose.position()) / (2.0 * kStep);
    EXPECT_NEAR((at.direction * tangent - Direction(at.pose.yaw)).norm(), 0.0, Tolerance(3e-9));
    EXPECT_NEAR(at.direction * (after.pose.yaw - before.pose.yaw) / (2.0 * kStep), at.curvature,
                Tolerance(6e-9));
    // Central differences of a quadratic function are exact.
    EXPECT_NEAR((after.curvature - before.curvature) / (2.0 * kStep), at.sharpness,
                Tolerance(1e-11));
    EXPECT_EQ(at.curvature, segment.CurvatureAt(s));
    EXPECT_EQ(at.direction, segment.direction);
  }
}

TEST(QuadraticSegment, MeetsItsNeighbors) {
  // Each segment continues with the final curvature of the previous one.
  Random random(54);
  std::vector<Segment> segments;
  for (int i = 0; i < 50; ++i) {
    Segment next = RandomSegment(random);
    next.direction = 1;
    if (i > 0) {
      next.curvature = segments.back().CurvatureAt(segments.back().length);
      next.sharpness = (random.Uniform(-0.2, 0.2) - next.curvature) / next.length -
                       0.5 * next.length * next.sharpness_rate;
    }
    segments.push_back(next);
  }
  const Path path({1.0, -2.0, 0.3}, segments);
  double joint = 0.0;
  for (const Segment& segment : segments) {
    joint += segment.length;
    constexpr double kStep = 1e-9;
    const PathPoint before = path.At(joint - kStep);
    const PathPoint after = path.At(std::min(joint + kStep, path.length()));
    // The points are 2e-9 m apart. Over this distance, a curvature of 0.3 1/m changes the heading
    // by 6e-10 rad, and a sharpness of 1.6 1/m^2 changes the curvature by 3.2e-9 1/m.
    EXPECT_NEAR((after.pose.position() - before.pose.position()).norm(), 0.0, Tolerance(2.1e-9));
    EXPECT_NEAR(after.pose.yaw, before.pose.yaw, Tolerance(1e-9));
    EXPECT_NEAR(after.curvature, before.curvature, Tolerance(4e-9));
  }
  EXPECT_EQ(path.At(path.length() + 1.0).curvature, 0.0);
  EXPECT_EQ(path.At(path.length() + 1.0).sharpness, 0.0);
}

TEST(QuadraticSegment, IsCheckedLikeAnyOther) {
  EXPECT_THROW(Path({}, {{1.0, 0.0, 1, HUGE_VAL}}), InternalError);
  EXPECT_THROW(Path({}, {{1.0, 0.0, 1, 0.0, std::nan("")}}), InternalError);
}

TEST(QuadraticSegment, ProjectFindsTheNearestOfAllPoints) {
  // Project may miss the nearest point if the car is close to a center of curvature. No random pose
  // of this test is that close.
  Random random(55);
  for (int i = 0; i < 100; ++i) {
    std::vector<Segment> segments;
    const int count = 1 + random.Below(4);
    for (int k = 0; k < count; ++k) {
      segments.push_back(RandomSegment(random));
    }
    const Path path({0.0, 0.0, random.Uniform(-4.0, 4.0)}, segments);
    for (int j = 0; j < 20; ++j) {
      Pose2 car = path.At(random.Uniform(-5.0, path.length() + 5.0)).pose;
      car.x += random.Uniform(-12.0, 12.0);
      car.y += random.Uniform(-12.0, 12.0);
      Stations within;
      if (j % 2 == 1) {
        within.from = random.Uniform(-10.0, path.length());
        within.to = within.from + random.Uniform(0.0, 20.0);
      }
      SCOPED_TRACE(fmt::format("case {}.{}: car ({}, {}), within [{}, {}]", i, j, car.x, car.y,
                               within.from, within.to));
      const Projection projection = path.Project(car, within);
      ASSERT_GE(projection.s, within.from);
      ASSERT_LE(projection.s, within.to);
      const Pose2 foot = path.At(projection.s).pose;
      const double nearest = (foot.position() - car.position()).norm();
      const double from = std::max(within.from, -20.0);
      const double to = std::min(within.to, path.length() + 20.0);
      for (int step = 0; step <= 500; ++step) {
        const double s = from + (to - from) * step / 500.0;
        ASSERT_GE((path.At(s).pose.position() - car.position()).norm(), nearest - 1e-11)
            << "s = " << s << ", found " << projection.s;
      }
      EXPECT_NEAR(projection.cross_track, ToLocal(foot, car.position()).y(), Tolerance(kRounding));
    }
  }
}

TEST(QuadraticSegment, ProjectOfACarBesideItIsItsStation) {
  // The projection is unique while the car's offset is less than the smallest radius of curvature,
  // 1/0.3 m.
  Random random(56);
  for (int i = 0; i < 300; ++i) {
    const Path path({3.0, 1.0, 0.4}, {RandomSegment(random)});
    const double s = random.Uniform(0.0, path.length());
    const double offset = random.Uniform(-2.0, 2.0);
    const Projection projection =
        path.Project(Compose(path.At(s).pose, {0.0, offset, 0.2}), {s - 3.0, s + 3.0});
    EXPECT_NEAR(projection.s, s, Tolerance(1e-9));
    // An error e of the station changes the cross-track error only by the order of e^2.
    EXPECT_NEAR(projection.cross_track, offset, Tolerance(kRounding));
    EXPECT_NEAR(projection.heading_error, 0.2, Tolerance(1e-9));
  }
}

// --- Cut
// ------------------------------------------------------------------------------------------

TEST(Cut, LeadsAlongTheSamePath) {
  Random random(57);
  for (int i = 0; i < 100; ++i) {
    std::vector<Segment> segments;
    for (int k = 0; k < 5; ++k) {
      Segment segment = RandomSegment(random);
      if (random.Below(2) == 0) {  // The segment becomes an arc or a line.
        segment.sharpness = 0.0;
        segment.sharpness_rate = 0.0;
        segment.curvature = random.Below(2) == 0 ? 0.0 : segment.curvature;
      }
      segments.push_back(segment);
    }
    const Path path({1.0, 2.0, 3.0}, segments);
    const double from = random.Uniform(0.0, path.length());
    const double to = random.Uniform(from, path.length());
    const Path cut(path.At(from).pose, path.Cut({from, to}));
    EXPECT_NEAR(cut.length(), to - from, Tolerance(kRounding));
    for (int k = 0; k <= 20; ++k) {
      const double s = cut.length() * (k + 0.5) / 21.0;
      ExpectPose(cut.At(s).pose, path.At(from + s).pose, 1e-9);
      EXPECT_NEAR(cut.At(s).curvature, path.At(from + s).curvature, Tolerance(1e-9));
      EXPECT_NEAR(cut.At(s).sharpness, path.At(from + s).sharpness, Tolerance(1e-9));
      EXPECT_EQ(cut.At(s).direction, path.At(from + s).direction);
    }
    ExpectPose(cut.At(cut.length()).pose, path.At(to).pose, 1e-9);
  }
}

TEST(Cut, OfEverythingIsThePathItself) {
  const Path path{{}, {{10.0, 0.0, 1}, {4.0, 0.0, 1, 0.05}, {3.0, 0.2, -1, 0.0, 0.01}}};
  EXPECT_EQ(path.Cut({}), path.segments());
  EXPECT_EQ(path.Cut({0.0, path.length()}), path.segments());
  EXPECT_EQ(path.Cut({-5.0, path.length() + 5.0}), path.segments());
}

TEST(Cut, AtJointsTakesWholeSegments) {
  const Path path{{}, {{10.0, 0.0, 1}, {4.0, 0.0, 1, 0.05}, {3.0, 0.2, -1}}};
  EXPECT_EQ(path.Cut({10.0, 14.0}), std::vector<Segment>{path.segments()[1]});
}

TEST(Cut, OfNothingIsEmpty) {
  const Path path = Corner();
  EXPECT_TRUE(path.Cut({4.0, 4.0}).empty());
  EXPECT_TRUE(path.Cut({path.length(), path.length() + 5.0}).empty());
  EXPECT_TRUE(path.Cut({-5.0, 0.0}).empty());
  EXPECT_TRUE(Path().Cut({}).empty());
}

// --- SegmentsThrough
// ------------------------------------------------------------------------------------------

/// A curve whose curvature oscillates: kappa(s) = a sin(w s). The third derivative of the curvature
/// is at most a w^3.
struct Sway {
  double a = 0.15;
  double w = 0.5;

  [[nodiscard]] double Yaw(double s) const { return a / w * (1.0 - std::cos(w * s)); }
  [[nodiscard]] Vec2 End(double s) const {
    // The error of Simpson's rule is below 0.1 1/m^4 x 20 m x (20 m/20000)^4/180 = 1e-14 m, because
    // the fourth derivatives are below 0.1 1/m^4.
    return {Simpson([&](double d) { return std::cos(Yaw(d)); }, s, 20000),
            Simpson([&](double d) { return std::sin(Yaw(d)); }, s, 20000)};
  }
  [[nodiscard]] Path Through(double length, double spacing) const {
    std::vector<CurvePoint> points;
    for (double i = 0.0; i <= std::round(length / spacing); i += 1.0) {
      const double s = spacing * i;
      points.push_back({s, Yaw(s), a * std::sin(w * s)});
    }
    return {{}, SegmentsThrough(points)};
  }
};

TEST(SegmentsThrough, KeepTheirBoundsWhichShrinkWithTheFourthPower) {
  constexpr double kLength = 20.0;
  const Sway sway;
  double last_yaw_error = 0.0;
  double last_end_error = 0.0;
  for (const double spacing : {2.0, 1.0, 0.5, 0.25}) {
    SCOPED_TRACE(spacing);
    const Path path = sway.Through(kLength, spacing);
    double yaw_error = 0.0;
    for (int i = 0; i <= 4000; ++i) {
      const double s = kLength * i / 4000.0;
      yaw_error = std::max(yaw_error, std::abs(path.At(s).pose.yaw - sway.Yaw(s)));
    }
    const double end_error = (path.At(path.length()).pose.position() - sway.End(kLength)).norm();
    const double bound = std::pow(spacing, 4) * sway.a * std::pow(sway.w, 3);
    EXPECT_LE(yaw_error, bound / 384.0 + kRounding);
    EXPECT_LE(end_error, bound / 720.0 * kLength + kRounding);
    if (last_yaw_error > 0.0) {
      // Halving the spacing divides the error by 16, except for terms of the next order. The terms
      // of the next order are smaller by the factor (w h)^2, where h is the coarser spacing.
      const double next_order = std::pow(2.0 * sway.w * spacing, 2);
      EXPECT_NEAR(last_yaw_error / yaw_error, 16.0, Tolerance(16.0 * next_order));
      EXPECT_NEAR(last_end_error / end_error, 16.0, Tolerance(16.0 * next_order));
    }
    last_yaw_error = yaw_error;
    last_end_error = end_error;
  }
}

TEST(SegmentsThrough, HaveTheCurvesHeadingAndCurvatureAtEveryPoint) {
  const Sway sway;
  const Path path = sway.Through(20.0, 0.5);
  for (double s = 0.0; s < 20.0; s += 0.5) {
    EXPECT_NEAR(path.At(s).pose.yaw, sway.Yaw(s), Tolerance(kRounding));
    EXPECT_NEAR(path.At(s).curvature, sway.a * std::sin(sway.w * s), Tolerance(kRounding));
  }
}

TEST(SegmentsThrough, OfAClothoidAreIt) {
  // The curvature is 0.02 s, and the points are unevenly spaced. The tolerance is the rounding
  // error of the headings, divided by the cube of the shortest distance between the points.
  std::vector<CurvePoint> points;
  for (const double s : {0.0, 0.5, 2.0, 3.5, 8.0}) {
    points.push_back({s, 0.01 * s * s, 0.02 * s});
  }
  const std::vector<Segment> segments = SegmentsThrough(points);
  ASSERT_EQ(segments.size(), 4U);
  for (const Segment& segment : segments) {
    EXPECT_NEAR(segment.sharpness, 0.02, Tolerance(1e-13));
    EXPECT_NEAR(segment.sharpness_rate, 0.0, Tolerance(1e-13));
    EXPECT_EQ(segment.direction, 1);
  }
  const Vec2 end = FresnelEnd(0.02, 8.0);
  ExpectPose(Path({}, segments).At(8.0).pose, {end.x(), end.y(), 0.64});
}

TEST(SegmentsThrough, NeedRisingDistances) {
  EXPECT_TRUE(SegmentsThrough({}).empty());
  EXPECT_TRUE(SegmentsThrough({{1.0, 0.0, 0.0}}).empty());
  EXPECT_THROW(SegmentsThrough({{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}), InternalError);
  EXPECT_THROW(SegmentsThrough({{1.0, 0.0, 0.0}, {0.5, 0.0, 0.0}}), InternalError);
}

TEST(SplitIntoLegs, EndWhereTheDirectionChanges) {
  const Path path({}, {{.length = 3.0},
                       {.length = 2.0, .curvature = 0.1},
                       {.length = 4.0, .curvature = 0.1, .direction = -1},
                       {.length = 1.0}});
  const std::vector<Stations> legs = SplitIntoLegs(path);
  ASSERT_EQ(legs.size(), 3U);
  EXPECT_EQ(legs[0].from, 0.0);
  EXPECT_EQ(legs[0].to, 5.0);
  EXPECT_EQ(legs[1].from, 5.0);
  EXPECT_EQ(legs[1].to, 9.0);
  EXPECT_EQ(legs[2].to, path.length());
  EXPECT_EQ(SplitIntoLegs(Path()).size(), 1U);
  EXPECT_EQ(SplitIntoLegs(Path()).front().to, 0.0);
}

}  // namespace path_test
}  // namespace trackbed
