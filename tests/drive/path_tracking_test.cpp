#include "src/drive/path_tracking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/tolerance.h"

namespace trackbed {
namespace {

/// A straight path of 10 m along x.
Path Straight() {
  return {{}, {{.length = 10.0}}};
}

Projection At(const Path& path, const Pose2& pose, double overrun = 0.4) {
  return DistanceFromPath(path, path.Project(pose), pose, overrun);
}

TEST(DistanceFromPath, IsToTheNearestPointOfAPathWithEnds) {
  // The pose is 20 m behind the start and 0.02 m beside the line.
  const Projection behind = At(Straight(), {-20.0, 0.02, 0.1});
  EXPECT_EQ(behind.s, 0.0);
  EXPECT_NEAR(behind.cross_track, std::hypot(20.0, 0.02), Tolerance(1e-12));
  EXPECT_NEAR(behind.heading_error, 0.1, Tolerance(1e-15));
  // The pose is 3 m past the end and 4 m to the right of the line, so it is 5 m from the end.
  const Projection beyond = At(Straight(), {13.0, -4.0, 0.0});
  EXPECT_EQ(beyond.s, 10.0);
  EXPECT_NEAR(beyond.cross_track, -5.0, Tolerance(1e-12));
}

TEST(DistanceFromPath, LetsACarStopALittleBeyondTheEnd) {
  const Projection stopped = At(Straight(), {10.3, 0.01, 0.0});
  EXPECT_NEAR(stopped.s, 10.3, Tolerance(1e-12));
  EXPECT_NEAR(stopped.cross_track, 0.01, Tolerance(1e-12));
  // The straight extension ends at the tolerance, so the distance is measured to its end.
  EXPECT_NEAR(At(Straight(), {10.5, 0.0, 0.0}).cross_track, 0.5, Tolerance(1e-12));
}

TEST(DistanceFromPath, IsThatOfThePathsOwnPointsAnywhere) {
  // Compares with brute force over points 1 mm apart, which errs by at most 0.5 mm.
  const Path path({1.0, 2.0, 0.3}, {{.length = 8.0},
                                    {.length = 6.0, .curvature = 0.2},
                                    {.length = 5.0, .curvature = 0.0, .sharpness = -0.02}});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-15.0, 25.0);
  for (int i = 0; i < 300; ++i) {
    const Pose2 pose{coordinate(random), coordinate(random), 0.0};
    double nearest = std::numeric_limits<double>::infinity();
    for (const PathPoint& point : path.Sample(1e-3)) {
      nearest = std::min(nearest, (point.pose.position() - pose.position()).norm());
    }
    EXPECT_NEAR(std::abs(At(path, pose, 0.0).cross_track), nearest, 5e-4)
        << pose.x << ", " << pose.y;
  }
}

}  // namespace
}  // namespace trackbed
