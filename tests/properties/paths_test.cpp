// Properties that paths and their queries must have for any segments, any pose and any station.

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/properties/property.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/path/frenet_frame.h"
#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"

namespace properties {
namespace {

using namespace trackbed;

/// Returns random lines, arcs and clothoids. The lengths are proportional to `scale` [m], and the
/// segments turn by a few radians.
std::vector<Segment> AnySegments(double scale, bool clothoids, bool forwards) {
  std::vector<Segment> segments;
  const int count = Pick(1, 6);
  for (int i = 0; i < count; ++i) {
    segments.push_back(
        {.length = scale * *Between(0.1, 30.0),
         .curvature = OnceIn(3) ? 0.0 : *Within(0.2) / scale,
         .direction = !forwards && OnceIn(4) ? -1 : 1,
         .sharpness = clothoids && OnceIn(2) ? *Within(0.01) / (scale * scale) : 0.0});
  }
  return segments;
}

/// Returns the rounding error of positions along a path [m]: 100 operations, each with an error of
/// 2.3e-16 times the largest number.
double RoundingOf(const Path& path, const Pose2& start) {
  return 100.0 * 2.3e-16 *
         (path.length() + std::abs(start.x) + std::abs(start.y) + std::abs(start.yaw));
}

TEST(AnyPath, GoesOnWhereItsSegmentsJoin) {
  Check(5.0, [] {
    const double scale = *PowerOfTen(-6, 6);
    const Pose2 start{*Within(1.0) * *PowerOfTen(0, 6), *Within(1.0) * *PowerOfTen(0, 6),
                      *Within(20.0)};
    const Path path(start, AnySegments(scale, true, false));
    double joint = 0.0;
    for (const Segment& segment : path.segments()) {
      joint += segment.length;
      const double h = 1e-6 * scale;
      const Pose2 before = path.At(joint - h).pose;
      const Pose2 after = path.At(joint + h).pose;
      const double tolerance = Tolerance(RoundingOf(path, start));
      RC_ASSERT((after.position() - before.position()).norm() <= 2.0 * h + tolerance);
      // The curvature is at most 0.2/scale, and the sharpness of 0.01/scale^2 over a length of 30
      // scale adds 0.3/scale. The sum is 0.5/scale.
      RC_ASSERT(std::abs(after.yaw - before.yaw) <=
                2.0 * h * 0.5 / scale + Tolerance(1e-13 * (std::abs(start.yaw) + 60.0)));
    }
  });
}

TEST(AnyPath, IsNowhereNearerThanItsProjection) {
  Check(5.0, [] {
    const double scale = *PowerOfTen(-6, 6);
    const Path path({}, AnySegments(scale, false, false));
    const Pose2 pose{scale * *Within(80.0), scale * *Within(80.0), *Within(20.0)};
    const Projection found = path.Project(pose);
    const double distance = (path.At(found.s).pose.position() - pose.position()).norm();
    RC_LOG() << "scale " << scale << ", pose " << pose.x << " " << pose.y << ", found s " << found.s
             << ", e " << found.cross_track << ", distance " << distance;
    const double tolerance = Tolerance(1e-9 * scale);
    RC_ASSERT(std::abs(found.cross_track) <= distance + tolerance);
    for (int i = -100; i <= 1100; ++i) {
      const double s = path.length() * i / 1000.0;
      RC_ASSERT((path.At(s).pose.position() - pose.position()).norm() >= distance - tolerance);
    }
  });
}

TEST(AnyPath, FindsItsOwnPointsAgain) {
  Check(5.0, [] {
    const double scale = *PowerOfTen(-3, 3);
    const Path path({}, AnySegments(scale, true, true));
    const double s = path.length() * *Between(-0.5, 1.5);
    const Pose2 pose = path.At(s).pose;
    const double near = 0.05 * scale;
    const Projection found = path.Project(pose, {s - near, s + near});
    RC_LOG() << "scale " << scale << ", s " << s << ", found " << found.s;
    // Projections on clothoids are accurate to 1e-9 m.
    RC_ASSERT(std::abs(found.s - s) <= Tolerance(1e-9 + 1e-9 * scale));
    RC_ASSERT(std::abs(found.cross_track) <= Tolerance(1e-9 + 1e-9 * scale));
    RC_ASSERT(std::abs(found.heading_error) <= Tolerance((1e-9 + 1e-9 * scale) / scale));
  });
}

TEST(AnyPath, GoesStraightOnBeyondItsEnds) {
  Check(5.0, [] {
    const double scale = *PowerOfTen(-6, 6);
    const Path path({}, OnceIn(5) ? std::vector<Segment>{} : AnySegments(scale, true, false));
    const double beyond = scale * *Between(0.0, 1e3);
    const PathPoint end = path.At(path.length() + beyond);
    const Pose2 last = path.At(path.length()).pose;
    const double reach = 1e-12 * (path.length() + beyond);
    RC_ASSERT(std::abs((end.pose.position() - last.position()).norm() - beyond) <=
              Tolerance(reach));
    RC_ASSERT(std::abs(end.pose.yaw - last.yaw) <= Tolerance(1e-12));
    RC_ASSERT(path.At(-beyond).pose.yaw == path.At(0.0).pose.yaw);
    RC_ASSERT(path.Sample(scale).size() >= 2U);
    RC_ASSERT(path.Cut({path.length() + 1.0, path.length() + 2.0}).empty());
    RC_ASSERT(SplitIntoLegs(path, {-1.0, path.length() + 1.0}).back().to == path.length());
  });
}

TEST(AnyPath, IsTheSameFromItsFrenetFrameAndBack) {
  Check(5.0, [] {
    const Path path({}, AnySegments(1.0, true, true));
    MotionState motion;
    const double s = path.length() * *Between(0.0, 1.0);
    motion.pose = Compose(path.At(s).pose, {0.0, *Within(1.5), *Within(1.2)});
    motion.curvature = *Within(0.2);
    motion.speed = *Within(10.0);
    motion.acceleration = *Within(3.0);
    const auto state = ToFrenet(path, motion, {s - 3.0, s + 3.0});
    if (!state) {
      return;  // The Frenet frame is singular at this pose.
    }
    const auto back = FromFrenet(path, *state);
    RC_ASSERT(back.has_value());
    // Projections are accurate to 1e-9 m. The error of a heading is this error times the curvature,
    // which is below 1 1/m.
    const double tolerance = Tolerance(2e-8);
    RC_ASSERT((back->pose.position() - motion.pose.position()).norm() <= tolerance);
    RC_ASSERT(std::abs(AngleDifference(back->pose.yaw, motion.pose.yaw)) <= tolerance);
    RC_ASSERT(std::abs(back->speed - motion.speed) <= 10.0 * tolerance);
  });
}

TEST(AnyPath, OfAnySegmentsIsMadeOrRefused) {
  Check(5.0, [] {
    const auto number = [] { return *Within(1.0) * *PowerOfTen(-300, 300); };
    std::vector<Segment> segments;
    const int count = Pick(0, 3);
    for (int i = 0; i < count; ++i) {
      segments.push_back({.length = std::abs(number()),
                          .curvature = number(),
                          .direction = Pick(-1, 1),
                          .sharpness = OnceIn(2) ? number() : 0.0});
    }
    const Pose2 pose{number(), number(), number()};
    const std::string refusal = Refusal([&] {
      const Path path({}, segments);
      (void)path.At(0.5 * path.length());
      (void)path.Project(pose);
      (void)path.Sample(path.length() / 7.0 + 1e-9);
      (void)StopAtCusps(path, 1.0, {3.0, 1.0, 1.0});
    });
    RC_TAG(refusal.substr(0, 17));
  });
}

TEST(AnySpeedProfile, StopsAtTheEndWithinItsLimits) {
  Check(5.0, [] {
    const double length = *Between(0.0, 1.0) * *PowerOfTen(-6, 6);
    const SpeedLimits limits{*Between(0.1, 50.0), *Between(0.1, 10.0), *Between(0.1, 10.0)};
    const double start = *Between(0.0, 50.0);
    std::vector<SpeedCap> caps;
    const int count = Pick(0, 3);
    for (int i = 0; i < count; ++i) {
      const double from = length * *Within(1.2);
      caps.push_back({from, from + length * *Between(0.0, 0.5), *Between(0.1, 10.0)});
    }
    const SpeedProfile profile = StopAtEnd(length, start, limits, caps);
    RC_ASSERT(profile.knots().back().speed == 0.0);
    RC_ASSERT(std::abs(profile.knots().back().s - length) <= 2e-9);
    const double most = std::max(limits.speed, start);
    for (int i = 0; i <= 100; ++i) {
      const double s = length * i / 100.0;
      const double speed = profile.SpeedAt(s);
      RC_ASSERT(speed >= 0.0);
      RC_ASSERT(speed <= most * (1.0 + Tolerance(1e-12)));
      RC_ASSERT(profile.AccelerationAt(s) <= limits.acceleration * (1.0 + Tolerance(1e-6)));
    }
  });
}

}  // namespace
}  // namespace properties
