#include "trackbed/planning/racing/center_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "tests/tolerance.h"
#include "tests/track/rings.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/racing/track_line.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/track/track.h"

namespace trackbed {
namespace {

using testing::HasSubstr;

constexpr double kRadius = 50.0;  // [m]

/// Returns a request for laps on a track. The car starts on the center line at the start line.
PlanRequest Laps(std::vector<TrackPoint> points, int laps) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.on_track = {std::make_shared<const Track>(std::move(points)), laps};
  request.start = request.on_track.track->At(0.0).pose;
  request.start_steering = std::atan(2.7 * request.on_track.track->At(0.0).curvature);
  request.speed = {.speed = 8.0, .acceleration = 1.5, .deceleration = 2.0};
  return request;
}

PlanRequest RingLaps(int laps) {
  return Laps(RingPoints(kRadius, 63, 4.0, 3.0), laps);
}

TEST(CenterLine, GoesRoundAsOftenAsAsked) {
  for (const int laps : {1, 3}) {
    const PlanRequest request = RingLaps(laps);
    const Plan plan = MakePlan(request, CenterLineOptions{});
    ASSERT_TRUE(plan.ok()) << plan.reason;
    const double lap = request.on_track.track->length();
    const Path& path = plan.reference.path;
    // Braking after the finish line takes v^2/(2 b) = 16 m. The length of the path is accurate up
    // to rounding.
    EXPECT_NEAR(path.length(), laps * lap + 16.0, Tolerance(1e-6));
    ASSERT_EQ(plan.laps.lines.size(), static_cast<std::size_t>(laps) + 1);
    for (int i = 0; i <= laps; ++i) {
      EXPECT_NEAR(plan.laps.lines[static_cast<std::size_t>(i)], i * lap, Tolerance(1e-6));
    }
    // The path follows the track's center line until the end of the last lap. SegmentsThrough is
    // accurate to 1e-7 m for a bend.
    for (double s = 0.0; s < path.length(); s += 5.0) {
      const PathPoint at = path.At(s);
      const PathPoint expected = request.on_track.track->At(s);
      EXPECT_NEAR((at.pose.position() - expected.pose.position()).norm(), 0.0, Tolerance(1e-5));
      EXPECT_NEAR(at.curvature, expected.curvature, Tolerance(1e-7));
    }
    EXPECT_EQ(plan.reference.speed.SpeedAt(path.length()), 0.0);
    // The car is still at full speed on the finish line.
    EXPECT_NEAR(plan.reference.speed.SpeedAt(plan.laps.lines.back()), 8.0, Tolerance(1e-6));
    EXPECT_TRUE(FindExcesses(plan, request).empty());
  }
}

TEST(CenterLine, FollowsTheTracksOwnCurvature) {
  const PlanRequest request = Laps(EllipsePoints(120.0, 60.0, 114, 5.0, 5.0), 1);
  const Plan plan = MakePlan(request, CenterLineOptions{});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const Track& track = *request.on_track.track;
  for (double s = 0.0; s < track.length(); s += 3.0) {
    const PathPoint at = plan.reference.path.At(s);
    EXPECT_NEAR((at.pose.position() - track.At(s).pose.position()).norm(), 0.0, Tolerance(1e-4));
    EXPECT_NEAR(at.curvature, track.At(s).curvature, Tolerance(1e-6));
    EXPECT_NEAR(plan.schedule.At(s), std::atan(2.7 * at.curvature), Tolerance(1e-4));
  }
}

TEST(CenterLine, MayStartBeforeTheLineAndBesideIt) {
  PlanRequest request = RingLaps(2);
  const Track& track = *request.on_track.track;
  request.start = Compose(track.At(-30.0).pose, {0.0, 1.5, 0.1});
  request.start_steering = 0.0;
  const Plan plan = MakePlan(request, CenterLineOptions{});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const Path& path = plan.reference.path;
  EXPECT_EQ(path.At(0.0).pose.position(), request.start.position());
  EXPECT_NEAR(path.At(0.0).pose.yaw, request.start.yaw, Tolerance(1e-9));
  ASSERT_EQ(plan.laps.lines.size(), 3U);
  // The start line is 30 m ahead. The car is 1.5 m inside of the center line, whose radius is 50 m,
  // and heads at an angle to it. This changes the distance to the start line by less than 1 m.
  EXPECT_NEAR(plan.laps.lines[0], 30.0, 1.0);
  for (const double line : plan.laps.lines) {
    const TrackPlace place = track.Locate(path.At(line).pose.position());
    EXPECT_NEAR(std::remainder(place.s, track.length()), 0.0, Tolerance(1e-4));
  }
  // The path reaches the center line within 24 m, which is 3 s at 8 m/s.
  EXPECT_NEAR(track.Locate(path.At(26.0).pose.position()).offset, 0.0, Tolerance(1e-4));
  // The path begins with straight wheels.
  EXPECT_NEAR(path.At(0.0).curvature, 0.0, Tolerance(1e-9));
}

TEST(CenterLine, CountsALapFromAStartBehindTheLine) {
  PlanRequest request = RingLaps(1);
  const Track& track = *request.on_track.track;
  request.start = track.At(20.0).pose;
  const Plan plan = MakePlan(request, CenterLineOptions{});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  ASSERT_EQ(plan.laps.lines.size(), 2U);
  EXPECT_EQ(plan.laps.lines[0], 0.0);
  EXPECT_NEAR(plan.laps.lines[1], track.length() - 20.0, 0.5);
}

TEST(CenterLine, MayStartFlying) {
  PlanRequest request = RingLaps(1);
  request.start_speed = 8.0;
  const Plan plan = MakePlan(request, CenterLineOptions{});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_EQ(plan.reference.speed.SpeedAt(0.0), 8.0);
  // The initial curvature matches the steering angle up to rounding.
  EXPECT_NEAR(plan.reference.path.At(0.0).curvature, std::tan(request.start_steering) / 2.7,
              Tolerance(1e-12));
}

// The car starts beside the center line at full speed. The usual length for joining the line is 25
// m, ten times the offset d. On this length, the wheels would have to turn at about v L 60 d/25^3 =
// 0.21 rad/s, faster than the limit of 0.15 rad/s.
TEST(CenterLine, LeadsARollingCarOntoTheLineAsFastAsItCanSteer) {
  for (const double offset : {2.5, -2.5}) {
    PlanRequest request = RingLaps(1);
    request.start = Compose(request.start, {0.0, offset, 0.0});
    request.start_speed = 8.0;
    const RouteStart route{.pose = request.start, .on_track = request.on_track};
    const std::optional<double> curvature = StartCurvatureOnTrack(CenterLineOptions{}, route);
    ASSERT_TRUE(curvature);
    EXPECT_NEAR(*curvature, 1.0 / (kRadius - offset), Tolerance(1e-4));
    request.start_steering = SteeringForCurvature(request.vehicle, *curvature);
    const Plan plan = MakePlan(request, CenterLineOptions{});
    ASSERT_TRUE(plan.ok()) << plan.reason;
    EXPECT_EQ(plan.reference.speed.SpeedAt(0.0), 8.0);
    const double join = DiagnosticsJson(plan).at("join_m").get<double>();
    EXPECT_GT(join, 25.0);
    request.start_speed = 0.0;
    const Plan at_rest = MakePlan(request, CenterLineOptions{});
    // From rest, the length is ten times the offset. The projection onto the center line finds the
    // offset to 1e-10 m.
    EXPECT_NEAR(DiagnosticsJson(at_rest).at("join_m").get<double>(), 25.0, Tolerance(1e-8));
  }
  EXPECT_FALSE(StartCurvatureOnTrack(CenterLineOptions{}, {}));
}

TEST(CenterLine, IsMovedAndTurnedWithItsTrack) {
  const Pose2 by{-200.0, 77.0, 2.1};
  const auto plan_on = [](std::vector<TrackPoint> points) {
    return MakePlan(Laps(std::move(points), 1), CenterLineOptions{});
  };
  std::vector<TrackPoint> moved = EllipsePoints(120.0, 60.0, 114, 5.0, 5.0);
  for (TrackPoint& point : moved) {
    point.position = ToWorld(by, point.position);
  }
  const Plan here = plan_on(EllipsePoints(120.0, 60.0, 114, 5.0, 5.0));
  const Plan there = plan_on(moved);
  ASSERT_TRUE(here.ok() && there.ok()) << there.reason;
  for (double s = 0.0; s < here.reference.path.length(); s += 7.0) {
    EXPECT_NEAR((ToWorld(by, here.reference.path.At(s).pose.position()) -
                 there.reference.path.At(s).pose.position())
                    .norm(),
                0.0, Tolerance(1e-6));
  }
}

TEST(CenterLine, IsSlowedDownForWhatTheTyresHold) {
  PlanRequest request = Laps(EllipsePoints(120.0, 60.0, 114, 5.0, 5.0), 1);
  request.vehicle.friction_lateral = 0.9;
  request.speed.speed = 25.0;  // 25^2/30 is 21 m/s^2.
  const Plan plan = MakePlan(request, CenterLineOptions{});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  ASSERT_FALSE(plan.notes.empty());
  EXPECT_THAT(plan.notes.front(), HasSubstr("lateral acceleration"));
  EXPECT_TRUE(FindExcesses(plan, request).empty());
}

TEST(CenterLine, StartsWhereTheTrackCrossesItself) {
  // The figure eight (a cos t, a sin t cos t) crosses itself at the origin, at t = pi/2 and
  // 3 pi/2, in the directions (-a, -a) and (a, -a). The start line is at t = 0.
  constexpr double kSize = 100.0;  // a [m]
  constexpr int kPoints = 240;
  std::vector<TrackPoint> eight;
  for (int i = 0; i < kPoints; ++i) {
    const double t = 2.0 * kPi * i / kPoints;
    eight.push_back({{kSize * std::cos(t), kSize * std::sin(t) * std::cos(t)}, 4.0, 4.0});
  }
  PlanRequest request = Laps(eight, 1);
  request.start_steering = 0.0;
  const double lap = request.on_track.track->length();
  for (const auto& [yaw, share] : {std::pair(-0.75 * kPi, 0.25), std::pair(-0.25 * kPi, 0.75)}) {
    request.start = {0.0, 0.0, yaw};
    const Plan plan = MakePlan(request, CenterLineOptions{});
    ASSERT_TRUE(plan.ok()) << yaw << ": " << plan.reason;
    // By symmetry, the crossing is at a quarter and at three quarters of the lap. After this
    // crossing, the car drives the rest of the lap, and possibly one more lap, until it passes the
    // start line for the last time. The points are 3 m apart, and the station of the crossing errs
    // by a small fraction of this distance.
    const double last = plan.laps.lines.back();
    EXPECT_NEAR(std::remainder(last + share * lap, lap), 0.0, 0.3) << yaw;
  }
  request.start = {0.0, 0.0, kPi / 2.0};  // 135 degrees from both directions
  const Plan refused = MakePlan(request, CenterLineOptions{});
  EXPECT_THAT(refused.reason, HasSubstr("does not look along the track"));
}

TEST(CenterLine, RefusesWithAReason) {
  PlanRequest request = RingLaps(1);
  request.on_track.track = nullptr;
  Plan plan = MakePlan(request, CenterLineOptions{});
  EXPECT_EQ(plan.status, PlanStatus::kNoPath);
  EXPECT_EQ(plan.reason, "there is no track to follow");

  request = RingLaps(1);
  request.start = Compose(request.start, {0.0, -4.1, 0.0});
  plan = MakePlan(request, CenterLineOptions{});
  EXPECT_EQ(plan.status, PlanStatus::kStartBlocked);
  EXPECT_THAT(plan.reason, HasSubstr("off the track: 4.1 m right of the center line"));

  request = RingLaps(1);
  request.start.yaw += kPi;
  plan = MakePlan(request, CenterLineOptions{});
  EXPECT_EQ(plan.status, PlanStatus::kStartBlocked);
  EXPECT_THAT(plan.reason, HasSubstr("does not look along the track"));

  request = RingLaps(1);
  request.vehicle.steering_limit = 0.03;  // The turning radius is 90 m.
  plan = MakePlan(request, CenterLineOptions{});
  EXPECT_EQ(plan.status, PlanStatus::kInfeasible);
  EXPECT_THAT(plan.reason, HasSubstr("steering"));
  EXPECT_EQ(plan.reference.path.length(), 0.0);
}

TEST(MeasureLine, OfACircleIsInClosedForm) {
  const Track track(RingPoints(kRadius, 63, 4.0, 3.0));
  const LineFindings center = MeasureLine(track, TrackLine());
  // The expected value is the integral of 1/r^2 over the circumference 2 pi r.
  EXPECT_NEAR(center.length, 2.0 * kPi * kRadius, Tolerance(1e-3));
  EXPECT_NEAR(center.curvature_square, 2.0 * kPi / kRadius, Tolerance(1e-6));
  EXPECT_NEAR(center.radius_min, kRadius, Tolerance(1e-3));
  // A closed spline with constant coefficients is a constant function. The line is then a circle 2
  // m farther out.
  const ClosedSplineBasis basis(track.length(), 40);
  const LineFindings outside =
      MeasureLine(track, TrackLine(basis, Eigen::MatrixXd::Constant(40, 1, -2.0)));
  EXPECT_NEAR(outside.length, 2.0 * kPi * (kRadius + 2.0), Tolerance(1e-3));
  EXPECT_NEAR(outside.curvature_square, 2.0 * kPi / (kRadius + 2.0), Tolerance(1e-6));
}

}  // namespace
}  // namespace trackbed
