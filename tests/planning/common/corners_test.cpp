#include "trackbed/planning/common/corners.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/planning/routes.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

using ::testing::HasSubstr;

const CornerLimits kLimits{.speed = 3.0, .min_speed = 0.5, .max_curvature = 1.0 / 5.1};

CollisionChecker NothingInTheWay() {
  return {ReferenceCar(), {}, 0.0};
}

/// Expects that the curvature is continuous, and that the wheels can follow its change at the speed
/// of the profile.
void ExpectDrivable(const RoundedCorners& rounded) {
  const auto& segments = rounded.path.segments();
  double curvature = 0.0;
  double station = 0.0;
  for (const Segment& segment : segments) {
    EXPECT_NEAR(segment.curvature, curvature, Tolerance(1e-9)) << "at " << station;
    curvature = segment.CurvatureAt(segment.length);
    EXPECT_LE(std::abs(curvature), kLimits.max_curvature + Tolerance(1e-12));
    double speed = kLimits.speed;
    const double middle = station + 0.5 * segment.length;
    for (const SpeedCap& cap : rounded.caps) {
      speed = cap.from <= middle && middle <= cap.to ? std::min(speed, cap.speed) : speed;
    }
    for (const double d : {0.0, 0.5 * segment.length, segment.length}) {
      const double kappa = segment.CurvatureAt(d);
      // The steering rate is d delta/dt for the steering angle delta = atan(L kappa), with the
      // wheelbase L = 2.7 m and the curvature kappa.
      const double rate = speed * 2.7 * segment.sharpness / (1.0 + 2.7 * 2.7 * kappa * kappa);
      EXPECT_LE(std::abs(rate), ReferenceCar().steering_rate * (1.0 + Tolerance(1e-9)));
    }
    station += segment.length;
  }
  EXPECT_NEAR(curvature, 0.0, Tolerance(1e-9));
}

TEST(CornerAt, TurnsByTheHeadingChangeBetweenTangentPoints) {
  for (const double h : {0.05, 0.25 * kPi, 0.5 * kPi, -0.5 * kPi, 2.5}) {
    for (const double speed : {0.5, 1.5, 3.0}) {
      const RoundCorner corner = CornerAt(ReferenceCar(), h, speed, kLimits.max_curvature);
      // A corner consists of a ramp of the curvature, an arc and a second ramp. The heading change
      // h of a corner is kappa^2/sigma plus kappa times the length of the arc, with the curvature
      // kappa and the sharpness sigma.
      const double ramp = corner.curvature / corner.sharpness;
      EXPECT_LE(corner.curvature * ramp, std::abs(h) * (1.0 + Tolerance(1e-12)));
      EXPECT_LE(corner.curvature, kLimits.max_curvature);
      EXPECT_TRUE(corner.curvature == kLimits.max_curvature ||
                  std::abs(corner.curvature * ramp - std::abs(h)) < Tolerance(1e-12));
      // With its ramps, the corner needs more of its legs than the arc alone, which needs
      // tan(|h|/2)/kappa_max.
      EXPECT_GT(corner.tangent_length, std::tan(0.5 * std::abs(h)) / kLimits.max_curvature);
    }
  }
}

TEST(CornerAt, NeedsMoreOfItsLegsTheFaster) {
  double before = 0.0;
  for (double speed = 0.2; speed < 6.0; speed += 0.1) {
    const double length =
        CornerAt(ReferenceCar(), 1.2, speed, kLimits.max_curvature).tangent_length;
    EXPECT_GT(length, before);
    before = length;
  }
}

TEST(RoundCorners, LeadsFromTheFirstPointToTheLast) {
  for (const std::vector<Vec2>& route : {RouteA(), RouteB()}) {
    const RoundedCorners rounded = RoundCorners(ReferenceCar(), route, kLimits, NothingInTheWay());
    ASSERT_EQ(rounded.status, PlanStatus::kOk) << rounded.reason;
    ExpectDrivable(rounded);
    const Path& path = rounded.path;
    const Vec2 last = route.back() - route[route.size() - 2];
    // The tangent lengths and the path use the same quadrature, so only rounding over 150 m
    // remains.
    EXPECT_NEAR((path.At(0.0).pose.position() - route.front()).norm(), 0.0, Tolerance(1e-12));
    EXPECT_NEAR((path.At(path.length()).pose.position() - route.back()).norm(), 0.0,
                Tolerance(1e-9));
    EXPECT_NEAR(AngleDifference(path.At(path.length()).pose.yaw, std::atan2(last.y(), last.x())),
                0.0, Tolerance(1e-9));
    EXPECT_TRUE(rounded.caps.empty());  // Legs of 36 m or more leave room for corners at 3 m/s.
  }
}

TEST(RoundCorners, SlowsDownWhereLegsAreShort) {
  const std::vector<Vec2> route{{0, 0}, {14, 0}, {14, 14}, {28, 14}};
  const RoundedCorners rounded = RoundCorners(ReferenceCar(), route, kLimits, NothingInTheWay());
  ASSERT_EQ(rounded.status, PlanStatus::kOk) << rounded.reason;
  ExpectDrivable(rounded);
  ASSERT_EQ(rounded.caps.size(), 2U);
  EXPECT_LT(rounded.caps[0].speed, 3.0);
  EXPECT_NEAR(rounded.corners[0].tangent_length, 7.0, Tolerance(1e-5));  // The tangent length is
                                                                         // half of the middle leg.
  const Vec2 end = rounded.path.At(rounded.path.length()).pose.position();
  EXPECT_NEAR((end - route.back()).norm(), 0.0, Tolerance(1e-9));
}

TEST(RoundCorners, RefusesWithTheCorner) {
  const auto reason = [](const std::vector<Vec2>& route, PlanStatus status) {
    const RoundedCorners rounded = RoundCorners(ReferenceCar(), route, kLimits, NothingInTheWay());
    EXPECT_EQ(rounded.status, status);
    EXPECT_EQ(rounded.path.length(), 0.0);
    EXPECT_TRUE(rounded.corners.empty());
    return rounded.reason;
  };
  EXPECT_THAT(reason({{0, 0}, {8, 0}, {8, 8}, {16, 8}}, PlanStatus::kTurnTooTight),
              HasSubstr("at (8, 0)"));
  EXPECT_THAT(reason({{0, 0}, {30, 0}, {10, 0}}, PlanStatus::kUTurn), HasSubstr("at (30, 0)"));
}

TEST(RoundCorners, KeepsClearByGoingSlowerOrRefuses) {
  const std::vector<Vec2> route{{0, 0}, {30, 0}, {30, 30}};
  const auto with_box = [&](double x, double y) {
    const CollisionChecker clear(ReferenceCar(), {{{x, y, 0.0}, 2.0, 2.0}}, 0.2);
    RoundedCorners rounded = RoundCorners(ReferenceCar(), route, kLimits, clear);
    if (rounded.status == PlanStatus::kOk) {
      EXPECT_FALSE(clear.FirstBlocked(rounded.path));
      ExpectDrivable(rounded);
    }
    return rounded;
  };
  // The box is inside the curve. At 3 m/s, the box is in the way of the curve. At a lower speed,
  // the curve stays closer to the corner, so the box is not in its way.
  const RoundedCorners slower = with_box(26.2, 3.8);
  ASSERT_EQ(slower.status, PlanStatus::kOk) << slower.reason;
  ASSERT_EQ(slower.caps.size(), 1U);
  EXPECT_LT(slower.caps[0].speed, 3.0);
  // A lower speed cannot avoid a box on the leg itself.
  EXPECT_EQ(with_box(10.0, 0.5).status, PlanStatus::kCollides);
  EXPECT_THAT(with_box(10.0, 0.5).reason, HasSubstr("obstacle"));
}

TEST(RoundCorners, MirrorsWithItsPolyline) {
  std::vector<Vec2> mirrored;
  for (const Vec2& point : RouteB()) {
    mirrored.push_back({point.x(), -point.y()});
  }
  const RoundedCorners a = RoundCorners(ReferenceCar(), RouteB(), kLimits, NothingInTheWay());
  const RoundedCorners b = RoundCorners(ReferenceCar(), mirrored, kLimits, NothingInTheWay());
  ASSERT_EQ(a.path.segments().size(), b.path.segments().size());
  for (double s = 0.0; s <= a.path.length(); s += 1.0) {
    const Pose2 p = a.path.At(s).pose;
    const Pose2 q = b.path.At(s).pose;
    EXPECT_NEAR((p.position() - Vec2(q.x, -q.y)).norm(), 0.0, Tolerance(1e-9));
  }
}

TEST(Shortcut, LeavesOutWhatCanBeSeenPast) {
  const std::vector<Vec2> points{{0, 0}, {1, 0}, {2, 0}, {3, 1}, {4, 2}, {5, 2}, {6, 2}};
  EXPECT_EQ(Shortcut(points, {}, 0.5), (std::vector<Vec2>{{0, 0}, {6, 2}}));
  EXPECT_EQ(WithoutCollinearPoints(points), (std::vector<Vec2>{{0, 0}, {2, 0}, {4, 2}, {6, 2}}));
  const std::vector<OrientedBox> boxes{{{1.8, 1.8, 0.0}, 1.0, 1.0}};
  const std::vector<Vec2> kept = Shortcut(points, boxes, 0.6);
  EXPECT_GT(kept.size(), 2U);
  for (std::size_t i = 1; i < kept.size(); ++i) {
    EXPECT_GT(Distance(kept[i - 1], kept[i], boxes[0]), 0.6);
  }
}

}  // namespace
}  // namespace trackbed
