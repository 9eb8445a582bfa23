#include "src/analysis/track_metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "tests/analysis/small_car.h"
#include "tests/tolerance.h"
#include "tests/track/rings.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

constexpr double kRadius = 50.0;  // [m]
constexpr double kSpeed = 10.0;   // [m/s]

/// A plan of laps on a ring, with the ring's stations.
Plan RingPlan(int laps, double width = 4.0) {
  Plan plan;
  plan.laps.track = std::make_shared<const Track>(RingPoints(kRadius, 63, width, width));
  for (int i = 0; i <= laps; ++i) {
    plan.laps.lines.push_back(i * plan.laps.track->length());
  }
  plan.reference.speed = SpeedProfile({{0.0, kSpeed}, {plan.laps.lines.back() + 50.0, kSpeed}});
  return plan;
}

/// A counter-clockwise drive on a circle around the origin, starting at the angle `from`.
RunLog Circle(double radius, double from, double speed, double duration) {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (int i = 0; i * 0.02 <= duration; ++i) {
    LogRow row;
    row.state.time = 0.02 * i;
    row.state.distance = speed * row.state.time;
    const double angle = from + row.state.distance / radius;
    row.state.pose = {radius * std::cos(angle), radius * std::sin(angle), angle + 0.5 * kPi};
    row.state.speed = speed;
    log.rows.push_back(row);
  }
  return log;
}

TEST(Laps, TakeTheirTimeBetweenCrossingsOfTheLine) {
  const double lap = 2.0 * kPi * kRadius / kSpeed;
  // The car drives 2.4 laps, starting 10 m before the line.
  const Plan plan = RingPlan(3);
  const RunLog log = Circle(kRadius, -0.2, kSpeed, 1.0 + 2.4 * lap);
  const std::vector<LapMetrics> laps = MeasureLaps(log, plan);
  ASSERT_EQ(laps.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    // Stations are interpolated linearly between rows 0.2 m apart, on a circle. The ring's own
    // length is accurate to 1e-4 m.
    EXPECT_NEAR(laps[i].time, lap, Tolerance(1e-4));
    EXPECT_NEAR(laps[i].time_planned, lap, Tolerance(1e-4));
    EXPECT_NEAR(laps[i].t, 1.0 + static_cast<double>(i + 1) * lap, Tolerance(1e-4));
    EXPECT_EQ(laps[i].s, plan.laps.lines[i + 1]);
  }
}

TEST(Laps, TellAFasterInnerLane) {
  // The car follows a circle whose radius is 3 m smaller, at the same speed.
  const std::vector<LapMetrics> laps =
      MeasureLaps(Circle(kRadius - 3.0, -0.2, kSpeed, 40.0), RingPlan(1));
  ASSERT_EQ(laps.size(), 1U);
  EXPECT_NEAR(laps[0].time, 2.0 * kPi * (kRadius - 3.0) / kSpeed, Tolerance(1e-4));
}

TEST(Laps, BeginWithTheRunOnTheLineOrBehindIt) {
  const double lap = 2.0 * kPi * kRadius / kSpeed;
  std::vector<LapMetrics> laps = MeasureLaps(Circle(kRadius, 0.0, kSpeed, 2.5 * lap), RingPlan(2));
  ASSERT_EQ(laps.size(), 2U);
  EXPECT_NEAR(laps[0].time, lap, Tolerance(1e-4));
  laps = MeasureLaps(Circle(kRadius, 0.2, kSpeed, 2.5 * lap), RingPlan(2));
  ASSERT_EQ(laps.size(), 2U);
  EXPECT_NEAR(laps[0].time, lap - 0.2 * kRadius / kSpeed, Tolerance(1e-4));
  EXPECT_NEAR(laps[1].time, lap, Tolerance(1e-4));
}

TEST(Laps, AreNoMoreThanPlannedAndNoneWithoutATrack) {
  const RunLog log = Circle(kRadius, -0.2, kSpeed, 100.0);
  EXPECT_EQ(MeasureLaps(log, RingPlan(1)).size(), 1U);
  EXPECT_TRUE(MeasureLaps(log, Plan{}).empty());
  EXPECT_FALSE(SmallestTrackMargin({log, Plan{}, SmallCar()}).has_value());
  EXPECT_FALSE(TimeOffTrack({log, Plan{}, SmallCar()}).has_value());
}

/// Smallest distance of sampled points of the footprint's outline from the track edges, negative
/// outside.
double BruteForceOnRing(const OrientedBox& box, double inner, double outer) {
  double smallest = std::numeric_limits<double>::infinity();
  constexpr int kParts = 400;
  for (int k = 0; k <= kParts; ++k) {
    const double u = static_cast<double>(k) / kParts - 0.5;
    for (const Vec2& local :
         {Vec2(u * box.length, 0.5 * box.width), Vec2(u * box.length, -0.5 * box.width),
          Vec2(0.5 * box.length, u * box.width), Vec2(-0.5 * box.length, u * box.width)}) {
      const double r = ToWorld(box.center, local).norm();
      smallest = std::min({smallest, r - inner, outer - r});
    }
  }
  return smallest;
}

TEST(TrackMargin, IsThatOfBruteForce) {
  const Track track(RingPoints(kRadius, 63, 4.0, 4.0));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(0.0, 2.0 * kPi);
  std::uniform_real_distribution<double> offset(-6.0, 6.0);
  std::uniform_real_distribution<double> slant(-0.4, 0.4);
  int off = 0;
  for (int i = 0; i < 500; ++i) {
    const double at = angle(random);
    const double r = kRadius + offset(random);
    const OrientedBox box{
        {r * std::cos(at), r * std::sin(at), at + 0.5 * kPi + slant(random)}, 4.0, 1.8};
    const double s = track.Locate(box.center.position()).s;
    const double expected = BruteForceOnRing(box, kRadius - 4.0, kRadius + 4.0);
    off += expected < 0.0 ? 1 : 0;
    // The edges are polylines. Linear interpolation of the widths between points 5 m apart errs by
    // 1e-4 m. Chords of 0.5 m deviate from the inner edge, a circle of radius 46 m, by 0.5^2/(8 x
    // 46) = 7e-4 m. Sampling the outline of the car at points 0.25 m apart adds 0.25^2/(8 x 46) =
    // 2e-4 m.
    EXPECT_NEAR(TrackMargin(track, box, s), expected, Tolerance(1.1e-3)) << i;
  }
  EXPECT_GT(off, 100);  // the sample has points on and off the track
}

TEST(TrackMargin, FindsTheInnerEdgeBetweenTheCorners) {
  // The inner edge bulges toward the middle of the car's side, so the car's corners are 4^2/(8 x
  // 46) m = 43 mm farther from this edge than the middle.
  const Track track(RingPoints(kRadius, 63, 4.0, 4.0));
  const OrientedBox box{{kRadius - 3.0, 0.0, 0.5 * kPi}, 4.0, 1.8};
  EXPECT_NEAR(TrackMargin(track, box, 0.0), (kRadius - 3.9) - (kRadius - 4.0), Tolerance(1.1e-3));
}

TEST(TrackLimits, TellHowFarHowLongAndWhere) {
  // The car drives 3.5 m outside of the center line. Half of the car's width is 0.9 m. The car's
  // front corners, 3 m ahead of the rear axle, are even farther outside.
  const Plan plan = RingPlan(1);
  const VehicleParams car = SmallCar();
  RunLog log = Circle(kRadius + 3.5, 0.1, kSpeed, 4.0);
  const double corner = std::hypot(kRadius + 3.5 + 0.9, 3.0) - (kRadius + 4.0);
  const auto margin = SmallestTrackMargin({log, plan, car});
  ASSERT_TRUE(margin);
  EXPECT_NEAR(std::get<double>(margin->value), -corner, Tolerance(1.1e-3));
  EXPECT_NEAR(std::get<double>(TimeOffTrack({log, plan, car})->value), 4.0, Tolerance(1e-9));
  EXPECT_NEAR(std::get<double>(DistanceOffTrack({log, plan, car})->value), 40.0, Tolerance(1e-9));
  // The car is off the track only during the middle second.
  const RunLog inside = Circle(kRadius, 0.1, kSpeed, 4.0);
  for (std::size_t i = 0; i < log.rows.size(); ++i) {
    const double time = log.rows[i].state.time;
    if (time < 1.5 - 1e-9 || time > 2.5 - 1e-9) {
      log.rows[i].state.pose = inside.rows[i].state.pose;
    }
  }
  EXPECT_NEAR(std::get<double>(TimeOffTrack({log, plan, car})->value), 1.0, Tolerance(1e-9));
  EXPECT_NEAR(std::get<double>(DistanceOffTrack({log, plan, car})->value), 10.0, Tolerance(1e-9));
  const auto worst = SmallestTrackMargin({log, plan, car});
  EXPECT_GE(worst->at.t, 1.5 - 1e-9);
  EXPECT_LT(worst->at.t, 2.5);
}

TEST(TrackLimits, TellTheMarginOfThePlannedPathUpToTheFinishLine) {
  // The planned path is a circle 2 m outside of the center line. Beyond the finish line, the path
  // continues straight and leaves the track.
  const double radius = kRadius + 2.0;
  Plan plan = RingPlan(1);
  const double lap = 2.0 * kPi * radius;
  plan.reference.path = Path({radius, 0.0, 0.5 * kPi},
                             {{.length = lap, .curvature = 1.0 / radius}, {.length = 60.0}});
  plan.laps.lines = {0.0, lap};
  const VehicleParams car = SmallCar();
  // The outer front corner is the part of the footprint that is nearest to an edge.
  const double corner = std::hypot(radius + 0.5 * car.width, 3.0);
  const RunLog log = Circle(kRadius, 0.0, kSpeed, 1.0);
  const auto margin = PlannedTrackMargin({log, plan, car});
  ASSERT_TRUE(margin);
  EXPECT_NEAR(std::get<double>(margin->value), kRadius + 4.0 - corner, Tolerance(1.1e-3));
  plan.laps.track = nullptr;
  EXPECT_FALSE(PlannedTrackMargin({log, plan, car}));
}

}  // namespace
}  // namespace trackbed
