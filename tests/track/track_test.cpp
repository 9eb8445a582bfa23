#include "trackbed/track/track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/tolerance.h"
#include "tests/track/rings.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

constexpr double kRadius = 50.0;

/// Returns a circular track of radius 50 m with 63 points, 5 m apart.
Track Ring(std::optional<double> smoothing = {}) {
  return Track(RingPoints(kRadius, 63, 4.0, 3.0), smoothing);
}

/// Returns the factor by which smoothing with the cutoff wavelength `length` multiplies a wave of
/// `wavelength`, as stated in closed_spline.h. Smoothing multiplies the radius of a circle by the
/// factor for a wavelength equal to the circumference.
double Left(double wavelength, double length) {
  return 1.0 / (1.0 + std::pow(wavelength / length, 6.0));
}

TEST(Track, OfARingIsARing) {
  const Track track = Ring();
  // Smoothing with a cutoff of 20 m reduces the radius of the circle, whose circumference is 314 m,
  // by the fraction (20/314)^6 = 7e-8, which is 3e-6 m. Interpolation by the spline, with points h
  // = 5 m apart on the radius r = 50 m, adds an error of (h/r)^6 r/30 = 2e-6 m. The tolerances
  // exceed both.
  EXPECT_NEAR(track.smoothing(), 20.0, Tolerance(0.1));
  for (double s = 0.0; s < track.length(); s += 1.3) {
    const PathPoint at = track.At(s);
    EXPECT_NEAR(at.pose.position().norm(), kRadius, Tolerance(1e-4)) << s;
    EXPECT_NEAR(at.curvature, 1.0 / kRadius, Tolerance(1e-7)) << s;
  }
  EXPECT_NEAR(track.length(), 2.0 * kPi * kRadius, Tolerance(2.0 * kPi * 1e-4));
}

TEST(Track, SmoothsByTheWavelength) {
  // If the circumference of a circle equals the cutoff wavelength, smoothing halves the radius.
  for (const double factor : {0.3, 0.5, 0.7}) {
    const double length = 2.0 * kPi * kRadius;
    const Track track = Ring(factor * length);
    const double expected = kRadius * Left(factor, 1.0);
    // The relative error of the reduction has two parts. The fit uses third differences in place of
    // third derivatives, which changes the penalty by the fraction (pi/126)^2 = 6.2e-4. The fit
    // measures chords in place of arcs, which are longer by the fraction (5/50)^2/24 = 4.2e-4. The
    // sixth power in the penalty multiplies this fraction by six, to 2.5e-3. The sum is 3.1e-3.
    const double taken = kRadius - expected;
    EXPECT_NEAR(track.At(0.25 * track.length()).pose.position().norm(), expected,
                Tolerance(3.1e-3 * taken + 1e-4))
        << factor;
    EXPECT_NEAR(track.deviation_max(), taken, Tolerance(3.1e-3 * taken + 1e-4));
    EXPECT_NEAR(track.deviation_rms(), taken, Tolerance(3.1e-3 * taken + 1e-4));
  }
}

TEST(Track, TakesNoiseOutOfTheCurvature) {
  std::vector<TrackPoint> points = RingPoints(kRadius, 63, 4.0, 3.0);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.1, 0.1);
  for (TrackPoint& point : points) {
    point.position += Vec2(noise(random), noise(random));
  }
  const Track smooth(points);
  const Track rough(points, 1.0);
  const auto worst = [](const Track& track) {
    double largest = 0.0;
    for (double s = 0.0; s < track.length(); s += 0.5) {
      largest = std::max(largest, std::abs(track.At(s).curvature - 1.0 / kRadius));
    }
    return largest;
  };
  // Noise of 0.1 m at a wavelength of 10 m has a curvature of 0.04 1/m. Smoothing reduces this
  // curvature to 1/65.
  EXPECT_GT(worst(rough), 0.02);
  EXPECT_LT(worst(smooth), 0.006);
  EXPECT_LT(smooth.deviation_max(), 0.1 * std::sqrt(2.0) + 0.02);
}

TEST(Track, KeepsItsEdgesWhereThePointsHaveThem) {
  // Strong smoothing moves the center line by more than 0.7 m. The edges must stay in place.
  const Track track = Ring(0.5 * 2.0 * kPi * kRadius);
  ASSERT_GT(track.deviation_max(), 0.7);
  for (const Vec2& point : track.left_edge()) {
    // The tolerance is the height of an arc over a chord of 5 m, for the left edge's radius of 47
    // m: 5^2/(8 x 47) = 0.066 m.
    EXPECT_NEAR(point.norm(), kRadius - 3.0, Tolerance(0.07));
  }
  for (const Vec2& point : track.right_edge()) {
    EXPECT_NEAR(point.norm(), kRadius + 4.0, Tolerance(0.07));
  }
}

TEST(Track, ClosesSmoothly) {
  const Track track(EllipsePoints(120.0, 60.0, 114, 5.0, 5.0));
  const PathPoint first = track.At(0.0);
  const PathPoint last = track.At(track.length() - 1e-9);
  // Track guarantees a gap of at most 1e-4 times the distance between the points, which is 5 m.
  EXPECT_NEAR((first.pose.position() - last.pose.position()).norm(), 0.0, Tolerance(5e-4));
  EXPECT_NEAR(std::remainder(first.pose.yaw - last.pose.yaw, 2.0 * kPi), 0.0, Tolerance(1e-6));
  EXPECT_NEAR(first.curvature, last.curvature, Tolerance(1e-6));
  EXPECT_EQ(track.At(track.length()).pose, first.pose);
  EXPECT_EQ(track.At(3.0 * track.length()).pose, first.pose);
  // The start is the end of the ellipse's long axis, where the radius of curvature is b^2/a = 30 m.
  EXPECT_NEAR((first.pose.position() - Vec2(120.0, 0.0)).norm(), 0.0, Tolerance(0.02));
  EXPECT_NEAR(1.0 / first.curvature, 30.0, Tolerance(0.3));
}

TEST(Track, LocatesPointsAndComesBack) {
  const Track track(EllipsePoints(120.0, 60.0, 114, 5.0, 5.0));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> station(0.0, track.length());
  std::uniform_real_distribution<double> offset(-5.0, 5.0);
  for (int i = 0; i < 200; ++i) {
    const double s = station(random);
    const double d = offset(random);
    const Vec2 point = ToWorld(track.At(s).pose, {0.0, d});
    const TrackPlace place = track.Locate(point);
    // Path::Project is accurate to 1e-9 m along the path.
    EXPECT_NEAR(std::remainder(place.s - s, track.length()), 0.0, Tolerance(1e-6));
    EXPECT_NEAR(place.offset, d, Tolerance(1e-6));
    const TrackPlace near = track.Locate(point, s + 7.0 * track.length() + 10.0);
    EXPECT_NEAR(std::remainder(near.s - s, track.length()), 0.0, Tolerance(1e-6));
  }
}

TEST(Track, HasLinearWidthsBetweenItsPoints) {
  std::vector<TrackPoint> points = RingPoints(kRadius, 63, 4.0, 3.0);
  points[10].width_left = 6.0;
  const Track track(points, 1.0);  // The wavelength of 1 m is too short to smooth: the center line
                                   // passes through the points.
  const double middle = 0.5 * (track.StationOf(10) + track.StationOf(11));
  // Halfway between the points, the left width is the mean of 6 m and 3 m. The tolerance allows for
  // the spline's uneven stations.
  EXPECT_NEAR(track.EdgesAt(middle).left, 4.5, Tolerance(1e-3));
  EXPECT_NEAR(track.EdgesAt(track.StationOf(10)).left, 6.0, Tolerance(1e-3));
  EXPECT_NEAR(track.EdgesAt(track.StationOf(10)).right, -4.0, Tolerance(1e-3));
  EXPECT_NEAR(track.EdgesAt(0.5 * (track.StationOf(62) + track.length())).left, 3.0,
              Tolerance(1e-3));
}

TEST(Track, FindsBendsTighterThanItsWidth) {
  EXPECT_FALSE(FindFold(Ring()));
  // The ellipse's smallest radius of curvature, 30 m, occurs at the start line and at the opposite
  // end.
  EXPECT_FALSE(FindFold(Track(EllipsePoints(120.0, 60.0, 114, 35.0, 27.0))));
  const auto fold = FindFold(Track(EllipsePoints(120.0, 60.0, 114, 5.0, 29.9)));
  ASSERT_TRUE(fold);
  EXPECT_EQ(fold->point, 0U);
  EXPECT_NEAR(fold->radius, 30.0, Tolerance(0.3));
  EXPECT_NEAR(fold->width, 29.9, Tolerance(0.05));
}

TEST(Track, RefusesWhatIsNoTrack) {
  EXPECT_THROW(Track(RingPoints(kRadius, 7, 4.0, 3.0)), PreconditionError);
  EXPECT_THROW(Track(RingPoints(kRadius, 63, 0.0, 3.0)), PreconditionError);
  EXPECT_THROW(Track(RingPoints(kRadius, 63, 4.0, -1.0)), PreconditionError);
  std::vector<TrackPoint> points = RingPoints(kRadius, 63, 4.0, 3.0);
  EXPECT_THROW(Track(points, 0.0), PreconditionError);
  points[5].position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Track{points}, PreconditionError);
  points[5] = points[4];
  EXPECT_THROW(Track{points}, PreconditionError);
  points = RingPoints(kRadius, 63, 4.0, 3.0);
  points.push_back(points.front());
  EXPECT_THROW(Track{points}, PreconditionError);
}

}  // namespace
}  // namespace trackbed
