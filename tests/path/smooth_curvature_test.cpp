#include "trackbed/path/smooth_curvature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

constexpr double kWindow = 4.0;  // [m]

/// Returns a path of a line, a quarter circle of radius 10 m to the left, and a line.
Path Turn() {
  return Path({1.0, 2.0, 0.5}, {{20.0, 0.0, 1}, {5.0 * kPi, 0.1, 1}, {20.0, 0.0, 1}});
}

TEST(SmoothCurvature, HasNoJumpsOfCurvature) {
  const Path rounded = SmoothCurvature(Turn(), kWindow);
  const auto& segments = rounded.segments();
  for (std::size_t i = 1; i < segments.size(); ++i) {
    EXPECT_NEAR(segments[i - 1].CurvatureAt(segments[i - 1].length), segments[i].curvature,
                Tolerance(1e-12));
  }
  // Over the window, the curvature rises linearly from 0 to the arc's 0.1 1/m. The slope may be 1.6
  // times larger, because the window is averaged in steps of 0.1 m.
  double steepest = 0.0;
  for (double s = 0.0; s < rounded.length(); s += 0.01) {
    steepest = std::max(steepest, std::abs(rounded.At(s).sharpness));
  }
  EXPECT_LT(steepest, 1.6 * 0.1 / kWindow);
}

TEST(SmoothCurvature, StaysWithinItsBound) {
  const Path turn = Turn();
  const Path rounded = SmoothCurvature(turn, kWindow);
  const double bound = kWindow * kWindow / 24.0 * 0.1;
  double most = 0.0;
  for (double s = 0.0; s <= rounded.length(); s += 0.1) {
    const Projection projection = turn.Project(rounded.At(s).pose, {s - 5.0, s + 5.0});
    // The tolerance allows for errors near the four kinks of the curvature. Simpson's rule, and the
    // quadratic curvature over each 0.1 m, cause these errors.
    EXPECT_GT(projection.cross_track, -Tolerance(1e-4));
    most = std::max(most, projection.cross_track);
  }
  EXPECT_LT(most, bound + Tolerance(1e-4));
  // The offset is largest in the middle of the arc: R (1 - sin(w/2R)/(w/2R)), with the radius R =
  // 10 m and the window w = 4 m.
  EXPECT_NEAR(most, 10.0 * (1.0 - std::sin(0.2) / 0.2), Tolerance(1e-4));
  EXPECT_NEAR(rounded.At(rounded.length()).pose.yaw, turn.At(turn.length()).pose.yaw,
              Tolerance(1e-12));
}

TEST(SmoothCurvature, CircleIsASmallerCircle) {
  const Path circle({0.0, 0.0, 0.0}, {{40.0, 0.1, 1}});
  const Path rounded = SmoothCurvature(circle, kWindow);
  const double radius = 10.0 * std::sin(0.2) / 0.2;
  const PathPoint middle = rounded.At(0.5 * rounded.length());
  EXPECT_NEAR(middle.curvature, 1.0 / radius, Tolerance(1e-9));
  EXPECT_NEAR((middle.pose.position() - Vec2{0.0, 10.0}).norm(), radius, Tolerance(1e-4));
}

TEST(SmoothCurvature, LeavesLinesAlone) {
  const Path line({1.0, 2.0, 0.5}, {{30.0, 0.0, 1}});
  const Path rounded = SmoothCurvature(line, kWindow);
  EXPECT_NEAR(rounded.length(), 30.0, Tolerance(1e-12));
  for (const double s : {0.0, 12.3, 30.0}) {
    EXPECT_NEAR((rounded.At(s).pose.position() - line.At(s).pose.position()).norm(), 0.0,
                Tolerance(1e-12));
  }
}

TEST(SmoothCurvature, RefusesWhatItCannotDo) {
  EXPECT_THROW(SmoothCurvature(Turn(), 0.0), InternalError);
  EXPECT_THROW(SmoothCurvature(Path(), 1.0), InternalError);
  EXPECT_THROW(SmoothCurvature(Path({0.0, 0.0, 0.0}, {{3.0, 0.0, -1}}), 1.0), InternalError);
}

}  // namespace
}  // namespace trackbed
