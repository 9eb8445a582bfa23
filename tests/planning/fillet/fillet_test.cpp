#include "trackbed/planning/fillet/fillet.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/planning/routes.h"
#include "tests/support/expect_near.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/fillet/steering_room.h"

// Tests fillet plans against the printed tables of routes A and B (Skackauskas, dissertation;
// constraint C.40 and identities C.9, C.14-C.19, listing F.1), against dense scans of the feasible
// radii, and against laws such as mirror symmetry. The last section rolls out the plans open loop
// with the kinematic car.
namespace trackbed {
namespace fillet_test {

using ::testing::HasSubstr;

constexpr double kSpeed = 3.0;

// Rounding error [m] of some ten operations on coordinates up to 100 m. Each operation has an error
// of 100 x 2^-53 = 1.1e-14 m.
constexpr double kRounding = 1e-12;

// The accuracy that PlanFillets guarantees for its path [m].
constexpr double kPromised = 1e-9;

FilletPlan PlanWith(const std::vector<Vec2>& route, RadiusConstraint constraint) {
  FilletOptions options;
  options.constraint = constraint;
  return PlanFillets(ReferenceCar(), route, kSpeed, options);
}

FilletPlan PlanGiven(const std::vector<Vec2>& route, double radius,
                     RadiusConstraint constraint = RadiusConstraint::kNone) {
  FilletOptions options;
  options.radius = radius;
  options.constraint = constraint;
  return PlanFillets(ReferenceCar(), route, kSpeed, options);
}

/// Returns a plan whose arcs pass each waypoint at a distance of at most `max_miss` [m].
FilletPlan PlanNear(const std::vector<Vec2>& route, double max_miss,
                    std::optional<double> radius = std::nullopt) {
  FilletOptions options;
  options.radius = radius;
  options.max_waypoint_miss = max_miss;
  return PlanFillets(ReferenceCar(), route, kSpeed, options);
}

std::string Describe(const std::vector<Vec2>& route) {
  std::string text = "route";
  for (const Vec2& w : route) {
    text += fmt::format(" ({}, {})", w.x(), w.y());
  }
  return text;
}

/// Returns the stations D_1, D_2, ... [m] at which the wheels begin to turn into and out of each
/// turn.
std::vector<double> Events(const FilletPlan& plan) {
  std::vector<double> events;
  for (const FilletTurn& turn : plan.turns) {
    events.push_back(turn.steer_start);
    events.push_back(turn.steer_return);
  }
  return events;
}

void ExpectEvents(const FilletPlan& plan, const std::vector<double>& expected) {
  const std::vector<double> events = Events(plan);
  ASSERT_EQ(events.size(), expected.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_NEAR(events[i], expected[i], Tolerance(Printed(4))) << "D_" << i + 1;
  }
}

// --- Conventions -------------------------------------------------------------------------------

TEST(PlanFillets, LeftTurnIsPositive) {
  const FilletPlan plan = PlanWith({{0, 0}, {60, 0}, {60, 60}}, RadiusConstraint::kSteeringRoom);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  ASSERT_EQ(plan.turns.size(), 1U);
  EXPECT_EQ(plan.turns[0].waypoint, 1);
  EXPECT_NEAR(plan.turns[0].heading_change, kPi / 2.0, Tolerance(kRounding));
  EXPECT_GT(plan.turns[0].steering, 0.0);
  EXPECT_GT(plan.turns[0].center.y(), 0.0);
  EXPECT_GT(plan.path.At(plan.turns[0].arc_start_s + 1.0).curvature, 0.0);
  EXPECT_GT(plan.schedule.At(plan.turns[0].steer_return), 0.0);
}

// --- Pass 1, r = 5.1 m --------------------------------------------------------------------------

TEST(PlanFillets, RouteAPassOneHasPrintedGeometry) {
  const FilletPlan plan = PlanGiven(RouteA(), 5.1);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  ASSERT_EQ(plan.turns.size(), 3U);
  // The expected values are closed forms. At right angles, the tangent length K equals the radius
  // r, so each point is 5.1 m from a waypoint along x or y.
  const std::vector<Vec2> starts{{34.9, 0}, {40, 34.9}, {74.9, 40}};
  const std::vector<Vec2> ends{{40, 5.1}, {45.1, 40}, {80, 45.1}};
  const std::vector<Vec2> centers{{34.9, 5.1}, {45.1, 34.9}, {74.9, 45.1}};
  const std::vector<double> signs{1.0, -1.0, 1.0};
  for (std::size_t k = 0; k < 3; ++k) {
    SCOPED_TRACE(k);
    const FilletTurn& turn = plan.turns[k];
    EXPECT_EQ(turn.waypoint, static_cast<int>(k) + 1);
    ExpectNear(turn.arc_start, starts[k], kRounding);
    ExpectNear(turn.arc_end, ends[k], kRounding);
    ExpectNear(turn.center, centers[k], kRounding);
    EXPECT_NEAR(turn.heading_change, signs[k] * kPi / 2.0, Tolerance(kRounding));
    EXPECT_NEAR(turn.interior_angle, kPi / 2.0, Tolerance(kRounding));
    EXPECT_NEAR(turn.tangent_length, 5.1, Tolerance(kRounding));
    EXPECT_NEAR(turn.arc_length, 5.1 * kPi / 2.0, Tolerance(kRounding));
    EXPECT_NEAR(turn.arc_length, 8.0111, Tolerance(Printed(4)));
    EXPECT_NEAR(turn.steering, signs[k] * std::atan(2.7 / 5.1), Tolerance(kRounding));
    EXPECT_NEAR(turn.ramp_time, 3.2337, Tolerance(Printed(4)));
    EXPECT_NEAR(turn.ramp_distance, 9.7012, Tolerance(Printed(4)));
    EXPECT_TRUE(turn.ramp_truncated);  // A ramp of 9.70 m does not fit into an arc of 8.01 m.
  }
}

TEST(PlanFillets, RouteAPassOneHasPrintedDistances) {
  const FilletPlan plan = PlanGiven(RouteA(), 5.1);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  ExpectEvents(plan, {30.0494, 38.0604, 67.8604, 75.8715, 105.6715, 113.6826});
  EXPECT_NEAR(plan.path.length(), 153.4332, Tolerance(Printed(4)));
  // The four legs are 40 m long. At each of the three corners, an arc of length r pi/2 replaces 2 r
  // of the legs.
  EXPECT_NEAR(plan.path.length(), 160.0 - 3.0 * 5.1 * (2.0 - kPi / 2.0), Tolerance(kRounding));
}

TEST(PlanFillets, RouteBPassOneHasPrintedGeometry) {
  const FilletPlan plan = PlanGiven(RouteB(), 5.1);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  ASSERT_EQ(plan.turns.size(), 3U);
  const std::vector<double> angles{146.3099, 123.6901, 116.5651};
  const std::vector<double> signs{1.0, 1.0, -1.0};
  const std::vector<double> tangents{1.5442, 2.7294, 3.1520};
  const std::vector<Vec2> starts{{28.4558, 0}, {57.7290, 18.4860}, {60, 56.8480}};
  const std::vector<Vec2> ends{{31.2848, 0.8565}, {60, 22.7294}, {62.8192, 61.4096}};
  const std::vector<Vec2> centers{{28.4558, 5.1}, {54.9, 22.7294}, {65.1, 56.8480}};
  for (std::size_t k = 0; k < 3; ++k) {
    SCOPED_TRACE(k);
    const FilletTurn& turn = plan.turns[k];
    EXPECT_NEAR(Degrees(turn.interior_angle), angles[k], Tolerance(Printed(4)));
    EXPECT_NEAR(turn.heading_change, signs[k] * (kPi - turn.interior_angle), Tolerance(kRounding));
    EXPECT_GT(signs[k] * turn.steering, 0.0);
    EXPECT_NEAR(turn.tangent_length, tangents[k], Tolerance(Printed(4)));
    ExpectNear(turn.arc_start, starts[k], Printed(4));
    ExpectNear(turn.arc_end, ends[k], Printed(4));
    ExpectNear(turn.center, centers[k], Printed(4));
  }
}

TEST(PlanFillets, RouteBPassOneHasPrintedDistances) {
  const FilletPlan plan = PlanGiven(RouteB(), 5.1);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  ExpectEvents(plan, {23.6052, 26.6040, 58.3860, 63.3982, 97.5168, 103.1633});
  EXPECT_NEAR(plan.path.length(), 149.5833, Tolerance(Printed(4)));
}

// --- Pass 2 -------------------------------------------------------------------------------------

TEST(PlanFillets, RouteAUnderHalfLegHasPrintedTurns) {
  const FilletPlan plan = PlanWith(RouteA(), RadiusConstraint::kHalfLeg);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  ASSERT_EQ(plan.turns.size(), 3U);
  const std::vector<Vec2> joints{{20, 0}, {40, 20}, {60, 40}, {80, 60}};
  const std::vector<Vec2> centers{{20, 20}, {60, 20}, {60, 60}};
  for (std::size_t k = 0; k < 3; ++k) {
    SCOPED_TRACE(k);
    const FilletTurn& turn = plan.turns[k];
    EXPECT_NEAR(turn.radius, 20.0, Tolerance(kRounding));
    EXPECT_NEAR(Degrees(std::abs(turn.steering)), 7.6884, Tolerance(Printed(4)));
    EXPECT_NEAR(turn.ramp_time, 0.8912, Tolerance(Printed(4)));
    EXPECT_NEAR(turn.ramp_distance, 2.6736, Tolerance(Printed(4)));
    ExpectNear(turn.arc_start, joints[k], kRounding);
    ExpectNear(turn.arc_end, joints[k + 1], kRounding);
    ExpectNear(turn.center, centers[k], kRounding);
    EXPECT_FALSE(turn.ramp_truncated);
  }
  ExpectEvents(plan, {18.6632, 50.0791, 50.0791, 81.4950, 81.4950, 112.9110});
  EXPECT_NEAR(plan.path.length(), 134.2478, Tolerance(Printed(4)));
  // The arcs touch each other without a straight between them. The path consists of a line, three
  // arcs and a line.
  EXPECT_EQ(plan.path.segments().size(), 5U);
}

TEST(PlanFillets, RouteBUnderHalfLegHasPrintedTurns) {
  const FilletPlan plan = PlanWith(RouteB(), RadiusConstraint::kHalfLeg);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  ASSERT_EQ(plan.turns.size(), 3U);
  const std::vector<double> radii{49.5416, 33.6852, 32.3607};
  const std::vector<double> steering{3.1195, 4.5827, -4.7694};
  const std::vector<double> times{0.3616, 0.5312, 0.5529};
  const std::vector<double> tangents{15.0, 18.0278, 20.0};
  const std::vector<Vec2> starts{{15, 0}, {45, 10}, {60, 40}};
  const std::vector<Vec2> ends{{42.4808, 8.3205}, {60, 38.0278}, {77.8885, 68.9443}};
  for (std::size_t k = 0; k < 3; ++k) {
    SCOPED_TRACE(k);
    const FilletTurn& turn = plan.turns[k];
    EXPECT_NEAR(turn.radius, radii[k], Tolerance(Printed(4)));
    EXPECT_NEAR(Degrees(turn.steering), steering[k], Tolerance(Printed(4)));
    EXPECT_NEAR(turn.ramp_time, times[k], Tolerance(Printed(4)));
    EXPECT_NEAR(turn.tangent_length, tangents[k], Tolerance(Printed(4)));
    ExpectNear(turn.arc_start, starts[k], Printed(4));
    ExpectNear(turn.arc_end, ends[k], Printed(4));
  }
  // The expected distances are the corrected ones. The listing itself gives D_3 = 46.6160 m,
  // because it uses the ramp of turn 1.
  ExpectEvents(plan, {14.4576, 43.5882, 46.3616, 79.4671, 81.4069, 117.2350});
  EXPECT_NEAR(plan.path.length(), 142.7856, Tolerance(Printed(4)));
}

TEST(PlanFillets, RouteAUnderSteeringRoomHasPrintedRadii) {
  const FilletPlan plan = PlanWith(RouteA(), RadiusConstraint::kSteeringRoom);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  ASSERT_EQ(plan.turns.size(), 3U);
  for (const FilletTurn& turn : plan.turns) {
    EXPECT_NEAR(turn.radius, 16.830685, Tolerance(Printed(6)));
  }
}

TEST(PlanFillets, DefaultsToTheLargestRadiusWithSteeringRoom) {
  const FilletOptions defaults;
  EXPECT_FALSE(defaults.radius.has_value());
  EXPECT_EQ(defaults.constraint, RadiusConstraint::kSteeringRoom);
  EXPECT_EQ(defaults.max_radius, 154.0);
}

TEST(PlanFillets, MaxRadiusCapsGentleTurns) {
  // A turn of 1 degree between legs of 100 m would allow the radius 50/tan(0.5 deg) m = 5730 m.
  const std::vector<Vec2> route{{0, 0}, {100, 0}, Vec2{100, 0} + 100.0 * Direction(Radians(1.0))};
  for (const RadiusConstraint constraint :
       {RadiusConstraint::kHalfLeg, RadiusConstraint::kSteeringRoom}) {
    const FilletPlan plan = PlanWith(route, constraint);
    ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
    EXPECT_EQ(plan.turns.at(0).radius, 154.0);
  }
}

// --- Single constraints -------------------------------------------------------------------------

TEST(SteeringRoomRadii, HasPrintedIntervals) {
  struct Case {
    double leg;
    double angle;
    std::optional<RadiusInterval> radii;
  };
  const std::vector<Case> cases{
      {40.0, 90.0, {{5.1, 16.830685}}},
      {30.0, 90.0, {{5.1, 9.461293}}},
      {29.0, 90.0, {{5.740928, 8.058521}}},
      {28.0, 90.0, std::nullopt},
      {26.0, 90.0, std::nullopt},
      {30.0, 146.3099, {{5.1, 45.654381}}},
      {36.05551, 123.69007, {{5.1, 30.385732}}},
      {40.0, 116.56505, {{5.1, 29.409195}}},
      {20.0, 120.0, std::nullopt},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(fmt::format("q = {}, phi = {} deg", c.leg, c.angle));
    const auto radii =
        SteeringRoomRadii(ReferenceCar(), kSpeed, Radians(c.angle), c.leg, {5.1, 154.0});
    ASSERT_EQ(radii.has_value(), c.radii.has_value());
    if (radii) {
      // The printed angles are rounded to 1e-4 or 1e-5 degrees. Rounding the angle phi by up to
      // 0.5e-4 degrees = 0.87e-6 rad moves the end of the interval of radii by this angle times
      // dr/dphi. The derivative dr/dphi is about r/sin(phi) = 82 m/rad at 146 degrees, so the error
      // is 82 x 0.87e-6 = 7.2e-5 m. Right angles are exact.
      const double tolerance = c.angle == 90.0   ? Printed(6)
                               : c.angle > 146.0 ? Printed(6) + 7.2e-5
                                                 : Printed(6) + 1e-5;
      EXPECT_NEAR(radii->low, c.radii->low, Tolerance(tolerance));
      EXPECT_NEAR(radii->high, c.radii->high, Tolerance(tolerance));
    }
  }
}

TEST(SteeringRoomRadii, RoutesBAnglesGiveThePrintedRadii) {
  // The angles are those of the previous test, but not rounded: the turns are atan(2/3), atan(3/2)
  // and atan(2).
  const VehicleParams car = ReferenceCar();
  const RadiusInterval bounds{5.1, 154.0};
  const auto first = SteeringRoomRadii(car, kSpeed, kPi - std::atan2(2.0, 3.0), 30.0, bounds);
  const auto second =
      SteeringRoomRadii(car, kSpeed, kPi - std::atan2(3.0, 2.0), std::sqrt(1300.0), bounds);
  const auto third = SteeringRoomRadii(car, kSpeed, kPi - std::atan(2.0), 40.0, bounds);
  ASSERT_TRUE(first && second && third);
  EXPECT_NEAR(first->high, 45.654381, Tolerance(Printed(6)));
  EXPECT_NEAR(second->high, 30.385732, Tolerance(Printed(6)));
  EXPECT_NEAR(third->high, 29.409195, Tolerance(1.5e-6));  // The source may round atan(2).
}

TEST(SteeringRoomRadii, AgreesWithADenseScan) {
  Random random(20240501);
  int intervals = 0;
  int interior_lows = 0;
  for (int i = 0; i < 600; ++i) {
    const double angle = Radians(random.Uniform(20.0, 178.0));
    const double leg = random.Uniform(10.0, 90.0);
    const double speed = random.Uniform(0.5, 5.0);
    SCOPED_TRACE(fmt::format("case {}: phi = {}, q = {}, v = {}", i, angle, leg, speed));
    const VehicleParams car = ReferenceCar();
    const RadiusInterval bounds{5.1, 154.0};
    // The printed constraint C.40 is g = K + S_delta - q/2 <= 0, with the tangent length K, the
    // length S_delta of the steering ramp and the shorter leg q.
    const auto g = [&](double r) {
      return r / std::tan(angle / 2.0) + speed * std::atan(2.7 / r) * 17.6 / 2.65 - leg / 2.0;
    };
    const auto radii = SteeringRoomRadii(car, speed, angle, leg, bounds);
    constexpr int kPoints = 4000;
    for (int j = 0; j <= kPoints; ++j) {
      const double r = bounds.low * std::pow(bounds.high / bounds.low, j / double{kPoints});
      const bool inside = radii && r >= radii->low && r <= radii->high;
      // The terms of g are below 1000 m. If |g| is below 1e-11 m, rounding may change the sign of
      // g.
      if (inside) {
        ASSERT_LE(g(r), 1e-11) << "r = " << r;
      } else {
        ASSERT_GE(g(r), -1e-11) << "r = " << r;
      }
    }
    if (radii) {
      ++intervals;
      interior_lows += radii->low > bounds.low ? 1 : 0;
      // The slope of g over the radius, at the roots of g, is below 1/tan(10 deg) + K0 L/(L^2 +
      // r^2) < 10. Rounding displaces a root of g by up to 154 x 2^-50 m.
      for (const double end : {radii->low, radii->high}) {
        if (end != bounds.low && end != bounds.high) {
          EXPECT_NEAR(g(end), 0.0, Tolerance(1e-11));
        }
      }
    }
  }
  // The cases include empty intervals, intervals that begin at the bound, and intervals inside the
  // bounds.
  EXPECT_GT(intervals, 100);
  EXPECT_LT(intervals, 500);
  EXPECT_GT(interior_lows, 5);
}

TEST(HalfLegRadii, HasPrintedShortestLegs) {
  // The shortest leg that allows a radius of 5.1 m is 2 x 5.1/tan(phi/2) long.
  const std::vector<std::pair<double, double>> table{
      {30.0, 2.733}, {60.0, 5.889}, {90.0, 10.2}, {120.0, 17.667}, {150.0, 38.067}};
  for (const auto& [change, leg] : table) {
    SCOPED_TRACE(change);
    const double angle = kPi - Radians(change);
    EXPECT_FALSE(HalfLegRadii(angle, leg - Tolerance(Printed(3)), {5.1, 154.0}));
    const auto radii = HalfLegRadii(angle, leg + Tolerance(Printed(3)), {5.1, 154.0});
    ASSERT_TRUE(radii);
    EXPECT_EQ(radii->low, 5.1);
    // The leg is rounded up by at most one unit in the last printed digit. The radius then exceeds
    // 5.1 m by at most half of this unit times tan(phi/2) <= 3.74.
    EXPECT_NEAR(radii->high, 5.1, Tolerance(0.5 * 2.0 * Printed(3) * 3.74));
  }
}

TEST(HalfLegRadii, EndsAtTheUpperBound) {
  const auto radii = HalfLegRadii(kPi / 2.0, 40.0, {5.1, 12.0});
  ASSERT_TRUE(radii);
  EXPECT_EQ(radii->high, 12.0);
}

// --- Laws ---------------------------------------------------------------------------------------

TEST(PlanFillets, ShiftedStartChangesNoDistance) {
  // Listing F.1 uses y(1) in place of x(1). This defect has an effect only if x(1) and y(1) differ.
  const std::vector<Vec2> offsets{{13.25, 0.0}, {0.0, -7.5}, {13.25, -7.5}, {-100.0, 250.0}};
  for (const auto& route : {RouteA(), RouteB()}) {
    const FilletPlan plan = PlanWith(route, RadiusConstraint::kHalfLeg);
    ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
    for (const Vec2& offset : offsets) {
      SCOPED_TRACE(fmt::format("offset ({}, {})", offset.x(), offset.y()));
      std::vector<Vec2> moved = route;
      for (Vec2& w : moved) {
        w += offset;
      }
      const FilletPlan shifted = PlanWith(moved, RadiusConstraint::kHalfLeg);
      ASSERT_EQ(shifted.status, PlanStatus::kOk) << shifted.reason;
      ASSERT_EQ(shifted.turns.size(), plan.turns.size());
      EXPECT_NEAR(shifted.path.length(), plan.path.length(), Tolerance(kRounding));
      for (std::size_t k = 0; k < plan.turns.size(); ++k) {
        const FilletTurn& a = plan.turns[k];
        const FilletTurn& b = shifted.turns[k];
        EXPECT_NEAR(b.radius, a.radius, Tolerance(kRounding));
        EXPECT_NEAR(b.steer_start, a.steer_start, Tolerance(kRounding));
        EXPECT_NEAR(b.steer_return, a.steer_return, Tolerance(kRounding));
        ExpectNear(b.arc_start, a.arc_start + offset, kRounding);
        ExpectNear(b.arc_end, a.arc_end + offset, kRounding);
        ExpectNear(b.center, a.center + offset, kRounding);
      }
    }
  }
}

/// Returns a random route. About half of these routes can be planned under constraint C.40.
std::vector<Vec2> PlannableRoute(Random& random, int count) {
  return RandomRoute(random, count, 25.0, 120.0, Radians(80.0));
}

TEST(PlanFillets, MirroredRouteGivesMirroredPlan) {
  Random random(7);
  int planned = 0;
  for (int i = 0; i < 200; ++i) {
    const std::vector<Vec2> route = PlannableRoute(random, 3 + random.Below(4));
    SCOPED_TRACE(Describe(route));
    std::vector<Vec2> mirrored = route;
    for (Vec2& w : mirrored) {
      w.y() = -w.y();
    }
    const FilletPlan a = PlanWith(route, RadiusConstraint::kSteeringRoom);
    const FilletPlan b = PlanWith(mirrored, RadiusConstraint::kSteeringRoom);
    ASSERT_EQ(a.status, b.status);
    ASSERT_EQ(a.waypoint, b.waypoint);
    if (a.status != PlanStatus::kOk) {
      continue;
    }
    ++planned;
    ASSERT_EQ(a.turns.size(), b.turns.size());
    for (std::size_t k = 0; k < a.turns.size(); ++k) {
      // Negating y is exact in every operation, so results of mirrored routes differ only in their
      // signs.
      EXPECT_NEAR(b.turns[k].heading_change, -a.turns[k].heading_change, Tolerance(kRounding));
      EXPECT_NEAR(b.turns[k].steering, -a.turns[k].steering, Tolerance(kRounding));
      EXPECT_NEAR(b.turns[k].radius, a.turns[k].radius, Tolerance(kRounding));
      EXPECT_NEAR(b.turns[k].steer_start, a.turns[k].steer_start, Tolerance(kRounding));
      EXPECT_NEAR(b.turns[k].steer_return, a.turns[k].steer_return, Tolerance(kRounding));
      ExpectNear(b.turns[k].center, {a.turns[k].center.x(), -a.turns[k].center.y()}, kRounding);
    }
    for (const double share : {0.1, 0.5, 0.9}) {
      const double s = share * a.path.length();
      const Pose2 pose = a.path.At(s).pose;
      const Pose2 reflected = b.path.At(s).pose;
      ExpectNear(reflected.position(), {pose.x, -pose.y}, kPromised);
      EXPECT_NEAR(AngleDifference(reflected.yaw, -pose.yaw), 0.0, Tolerance(kPromised));
      EXPECT_NEAR(b.schedule.At(s), -a.schedule.At(s), Tolerance(kRounding));
    }
  }
  EXPECT_GT(planned, 40);
}

TEST(PlanFillets, MovedRouteGivesMovedPlan) {
  Random random(8);
  int planned = 0;
  for (int i = 0; i < 200; ++i) {
    const std::vector<Vec2> route = PlannableRoute(random, 3 + random.Below(4));
    const Pose2 X_WA{random.Uniform(-100.0, 100.0), random.Uniform(-100.0, 100.0),
                     random.Uniform(-kPi, kPi)};
    SCOPED_TRACE(
        fmt::format("moved by ({}, {}, {}); {}", X_WA.x, X_WA.y, X_WA.yaw, Describe(route)));
    std::vector<Vec2> moved;
    for (const Vec2& w : route) {
      moved.push_back(ToWorld(X_WA, w));
    }
    const FilletPlan a = PlanWith(route, RadiusConstraint::kSteeringRoom);
    const FilletPlan b = PlanWith(moved, RadiusConstraint::kSteeringRoom);
    ASSERT_EQ(a.status, b.status);
    if (a.status != PlanStatus::kOk) {
      continue;
    }
    ++planned;
    ASSERT_EQ(a.turns.size(), b.turns.size());
    for (std::size_t k = 0; k < a.turns.size(); ++k) {
      // Rounding errors are 1e-13 m for waypoints up to 700 m away, and 1e-14 rad for headings of
      // legs of 25 m. At radii for which g is nearly constant, these errors change the radius by up
      // to some thousand times as much.
      EXPECT_NEAR(b.turns[k].steering, a.turns[k].steering, Tolerance(1e-9));
      EXPECT_NEAR(b.turns[k].steer_start, a.turns[k].steer_start, Tolerance(1e-9));
      ExpectNear(b.turns[k].center, ToWorld(X_WA, a.turns[k].center), 1e-9);
    }
    const double s = 0.5 * a.path.length();
    const Pose2 expected = Compose(X_WA, a.path.At(s).pose);
    ExpectNear(b.path.At(s).pose.position(), expected.position(), 1e-8);
    EXPECT_NEAR(AngleDifference(b.path.At(s).pose.yaw, expected.yaw), 0.0, Tolerance(1e-9));
  }
  EXPECT_GT(planned, 40);
}

/// Checks the identities C.14 to C.19 and the path. Every plan must satisfy them, however its radii
/// were chosen.
void ExpectFilletIdentities(const std::vector<Vec2>& route, const FilletPlan& plan) {
  double legs = 0.0;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    legs += (route[i + 1] - route[i]).norm();
  }
  double saved = 0.0;
  for (const FilletTurn& turn : plan.turns) {
    SCOPED_TRACE(fmt::format("turn at waypoint {}", turn.waypoint));
    const auto i = static_cast<std::size_t>(turn.waypoint);
    const Vec2 in = (route[i] - route[i - 1]).normalized();
    const Vec2 out = (route[i + 1] - route[i]).normalized();
    // The printed formula C.9 uses the arc cosine, which loses half of the digits near a straight
    // line.
    EXPECT_NEAR(turn.interior_angle, std::acos(std::clamp(-in.dot(out), -1.0, 1.0)),
                Tolerance(1e-7));
    EXPECT_EQ(turn.heading_change > 0.0, Cross(in, out) > 0.0);
    EXPECT_NEAR(std::abs(turn.heading_change) + turn.interior_angle, kPi, Tolerance(kRounding));
    EXPECT_NEAR((turn.center - turn.arc_start).norm(), turn.radius, Tolerance(kPromised));
    EXPECT_NEAR((turn.center - turn.arc_end).norm(), turn.radius, Tolerance(kPromised));
    EXPECT_NEAR((turn.center - turn.arc_start).dot(in), 0.0, Tolerance(kPromised));
    EXPECT_NEAR((turn.center - turn.arc_end).dot(out), 0.0, Tolerance(kPromised));
    EXPECT_NEAR((route[i] - turn.arc_start).norm(), turn.tangent_length, Tolerance(kPromised));
    EXPECT_NEAR((turn.arc_end - route[i]).norm(), turn.tangent_length, Tolerance(kPromised));
    saved += 2.0 * turn.tangent_length - turn.radius * std::abs(turn.heading_change);

    const PathPoint begin = plan.path.At(turn.arc_start_s);
    const PathPoint end = plan.path.At(turn.arc_start_s + turn.arc_length);
    ExpectNear(begin.pose.position(), turn.arc_start, kPromised);
    ExpectNear(end.pose.position(), turn.arc_end, kPromised);
    EXPECT_NEAR((Direction(begin.pose.yaw) - in).norm(), 0.0, Tolerance(kPromised));
    EXPECT_NEAR((Direction(end.pose.yaw) - out).norm(), 0.0, Tolerance(kPromised));
    EXPECT_NEAR(plan.path.At(turn.arc_start_s + 0.5 * turn.arc_length).curvature * turn.radius,
                std::copysign(1.0, turn.heading_change), Tolerance(kRounding));

    EXPECT_NEAR(std::tan(turn.steering) * turn.radius, std::copysign(2.7, turn.heading_change),
                Tolerance(kRounding));
    EXPECT_NEAR(turn.ramp_time, std::abs(turn.steering) * 17.6 / 2.65, Tolerance(kRounding));
    EXPECT_NEAR(turn.ramp_distance, turn.speed * turn.ramp_time, Tolerance(kRounding));
    EXPECT_NEAR(turn.steer_start, turn.arc_start_s - 0.5 * turn.ramp_distance,
                Tolerance(kPromised));
    EXPECT_NEAR(turn.steer_return, turn.arc_start_s + turn.arc_length - 0.5 * turn.ramp_distance,
                Tolerance(kPromised));
    EXPECT_EQ(turn.ramp_truncated, turn.arc_length < turn.ramp_distance);
  }
  EXPECT_NEAR(plan.path.length(), legs - saved, Tolerance(kPromised));
  const Pose2 start = plan.path.At(0.0).pose;
  const Pose2 end = plan.path.At(plan.path.length()).pose;
  ExpectNear(start.position(), route.front(), kPromised);
  ExpectNear(end.position(), route.back(), kPromised);
  const Vec2 first = (route[1] - route[0]).normalized();
  const Vec2 last = (route.back() - route[route.size() - 2]).normalized();
  EXPECT_NEAR((Direction(start.yaw) - first).norm(), 0.0, Tolerance(kPromised));
  EXPECT_NEAR((Direction(end.yaw) - last).norm(), 0.0, Tolerance(kPromised));
}

/// Expects that position and heading are continuous where segments meet.
void ExpectContinuous(const Path& path) {
  double s = 0.0;
  for (std::size_t i = 0; i + 1 < path.segments().size(); ++i) {
    s += path.segments()[i].length;
    // The samples are 1e-7 m before and after the joint. Over this distance, the heading changes by
    // at most 2e-8 rad, as r >= 5.1 m. Straight extrapolation has an error of (1e-7)^2/(2 x 5.1) =
    // 1e-15 m.
    constexpr double kNear = 1e-7;
    const PathPoint before = path.At(s - kNear);
    const PathPoint after = path.At(s + kNear);
    EXPECT_NEAR((after.pose.position() - before.pose.position() -
                 kNear * (Direction(before.pose.yaw) + Direction(after.pose.yaw)))
                    .norm(),
                0.0, Tolerance(kPromised));
    EXPECT_NEAR(AngleDifference(after.pose.yaw, before.pose.yaw),
                kNear * (before.curvature + after.curvature), Tolerance(kPromised));
  }
}

TEST(PlanFillets, RandomRoutesKeepTheIdentitiesOrSayWhy) {
  Random random(1984);
  int planned = 0;
  int refused = 0;
  int slowed = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::vector<Vec2> route =
        i % 2 == 0 ? PlannableRoute(random, 3 + random.Below(10))
                   : RandomRoute(random, 3 + random.Below(10), 8.0, 90.0, Radians(150.0));
    FilletOptions options;
    switch (random.Below(3)) {
      case 0:
        options.constraint = RadiusConstraint::kSteeringRoom;
        break;
      case 1:
        options.constraint = RadiusConstraint::kHalfLeg;
        break;
      default:
        options.constraint = RadiusConstraint::kNone;
        options.radius = random.Uniform(5.1, 12.0);
    }
    SCOPED_TRACE(fmt::format("case {}, constraint {}, radius {}; {}", i,
                             static_cast<int>(options.constraint), options.radius.value_or(0.0),
                             Describe(route)));
    const FilletPlan plan = PlanFillets(ReferenceCar(), route, kSpeed, options);
    if (plan.status != PlanStatus::kOk) {
      ++refused;
      EXPECT_GE(plan.waypoint, 1);
      EXPECT_LT(plan.waypoint, static_cast<int>(route.size()));
      EXPECT_THAT(plan.reason, HasSubstr(fmt::format("waypoint {}", plan.waypoint)));
      continue;
    }
    ++planned;
    EXPECT_EQ(plan.waypoint, -1);
    EXPECT_EQ(plan.reason, "");
    if (!plan.left_out.empty()) {
      EXPECT_LE(plan.turns.size(), route.size() - 2 - plan.left_out.size());
      ExpectContinuous(plan.path);
      continue;  // the turns have other legs
    }
    ASSERT_EQ(plan.turns.size(), route.size() - 2);
    ExpectFilletIdentities(route, plan);
    ExpectContinuous(plan.path);
    for (const FilletTurn& turn : plan.turns) {
      const auto w = static_cast<std::size_t>(turn.waypoint);
      const double q = std::min((route[w] - route[w - 1]).norm(), (route[w + 1] - route[w]).norm());
      const bool steering_room = options.constraint == RadiusConstraint::kSteeringRoom &&
                                 turn.note.find("under C.34") == std::string::npos;
      // At the lowest speed, half a ramp on the leg suffices.
      const double ramps = turn.note.find("half of the ramp") == std::string::npos ? 1.0 : 0.5;
      const auto need = [&](double r) {
        return r / std::tan(turn.interior_angle / 2.0) +
               (steering_room ? ramps * turn.speed * std::atan(2.7 / r) * 17.6 / 2.65 : 0.0);
      };
      EXPECT_LE(turn.speed, kSpeed);
      EXPECT_TRUE(turn.speed == kSpeed || turn.note != "") << "slower without a reason";
      slowed += turn.speed < kSpeed ? 1 : 0;
      if (options.constraint == RadiusConstraint::kNone) {
        EXPECT_EQ(turn.radius, *options.radius);
      } else {
        EXPECT_LE(need(turn.radius), q / 2.0 + Tolerance(kPromised));
        EXPECT_LE(turn.radius, options.max_radius);
        if (turn.radius < options.max_radius) {
          EXPECT_GT(need(turn.radius * (1.0 + 1e-6)), q / 2.0) << "not the largest radius";
        }
      }
    }
  }
  EXPECT_GT(planned, 250);
  EXPECT_GT(refused, 200);
  EXPECT_GT(slowed, 100);
}

TEST(PlanFillets, EndsAtGoalAfterALongFirstLeg) {
  // The last straight is shorter than 1e-9 times the first leg, but longer than the promised
  // accuracy kPromised.
  const double rest = 5e-7;
  const std::vector<Vec2> route{{0, 0}, {1000, 0}, {1000, 10.0 + rest}};
  const FilletPlan plan = PlanGiven(route, 10.0);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  ExpectNear(plan.path.At(plan.path.length()).pose.position(), route.back(), kPromised);
}

TEST(PlanFillets, CollinearWaypointsMakeNoTurn) {
  const FilletPlan straight = PlanWith({{0, 0}, {20, 0}, {50, 0}}, RadiusConstraint::kSteeringRoom);
  ASSERT_EQ(straight.status, PlanStatus::kOk) << straight.reason;
  EXPECT_TRUE(straight.turns.empty());
  EXPECT_EQ(straight.path.segments(), (std::vector<Segment>{{50.0, 0.0, 1}}));
  EXPECT_EQ(straight.schedule.At(25.0), 0.0);

  const std::vector<Vec2> plain{{0, 0}, {60, 0}, {60, 60}};
  const std::vector<Vec2> split{{0, 0}, {10, 0}, {60, 0}, {60, 50}, {60, 60}};
  const FilletPlan a = PlanGiven(plain, 12.0);
  const FilletPlan b = PlanGiven(split, 12.0);
  ASSERT_EQ(b.status, PlanStatus::kOk) << b.reason;
  ASSERT_EQ(b.turns.size(), 1U);
  EXPECT_EQ(b.turns[0].waypoint, 2);
  EXPECT_NEAR(b.turns[0].steer_start, a.turns[0].steer_start, Tolerance(kRounding));
  EXPECT_NEAR(b.path.length(), a.path.length(), Tolerance(kRounding));
  EXPECT_EQ(b.path.segments().size(), 3U);
  ExpectNear(b.path.At(b.path.length()).pose.position(), {60, 60}, kRounding);
}

TEST(PlanFillets, CollinearWaypointsNeedNoExactNumbers) {
  // The waypoints at thirds of a slanted line are rounded, so the heading changes between the legs
  // are rounding errors.
  const Vec2 end{31.7, 17.3};
  const FilletPlan plan =
      PlanWith({{0, 0}, end / 3.0, end * (2.0 / 3.0), end}, RadiusConstraint::kSteeringRoom);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  EXPECT_TRUE(plan.turns.empty());
  ExpectNear(plan.path.At(plan.path.length()).pose.position(), end, kPromised);
}

TEST(PlanFillets, GivenRadiusOnTheConstraintIsAccepted) {
  // At the printed radius of route A, 20 m, every turn satisfies the constraint with equality, up
  // to rounding.
  const FilletPlan half = PlanGiven(RouteA(), 20.0, RadiusConstraint::kHalfLeg);
  EXPECT_EQ(half.status, PlanStatus::kOk) << half.reason;
}

TEST(PlanFillets, ChosenRadiusCanBeGivenBack) {
  const double half = PlanWith(RouteA(), RadiusConstraint::kHalfLeg).turns.at(0).radius;
  EXPECT_EQ(PlanGiven({{0, 0}, {40, 0}, {40, 40}}, half, RadiusConstraint::kHalfLeg).status,
            PlanStatus::kOk);
  const double room = PlanWith(RouteA(), RadiusConstraint::kSteeringRoom).turns.at(0).radius;
  EXPECT_EQ(PlanGiven({{0, 0}, {40, 0}, {40, 40}}, room, RadiusConstraint::kSteeringRoom).status,
            PlanStatus::kOk);
}

TEST(PlanFillets, SmallestRadiusOfTheCarIsAccepted) {
  // Because of rounding, 2.7/tan(atan(2.7/5.1)) is not exactly 5.1.
  EXPECT_EQ(PlanGiven({{0, 0}, {40, 0}, {40, 40}}, 5.1).status, PlanStatus::kOk);
}

// --- Rejections ---------------------------------------------------------------------------------

void ExpectRefused(const FilletPlan& plan, PlanStatus status, int waypoint,
                   const std::string& reason) {
  EXPECT_EQ(plan.status, status) << ToString(plan.status) << ": " << plan.reason;
  EXPECT_EQ(plan.waypoint, waypoint);
  EXPECT_THAT(plan.reason, HasSubstr(reason));
}

TEST(PlanFillets, DrivesStraightBetweenTwoWaypoints) {
  const Vec2 from{1.0, -2.0};
  const Vec2 to{31.0, 38.0};
  for (const RadiusObjective objective : {RadiusObjective::kLargest, RadiusObjective::kLiteral,
                                          RadiusObjective::kTurnLocal, RadiusObjective::kDriven}) {
    FilletOptions options;
    options.objective = objective;
    const FilletPlan plan = PlanFillets(ReferenceCar(), {from, to}, 3.0, options);
    ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
    EXPECT_TRUE(plan.turns.empty());
    ASSERT_EQ(plan.path.segments().size(), 1U);
    EXPECT_EQ(plan.path.segments()[0].curvature, 0.0);
    // The leg is the hypotenuse of 30 m and 40 m; rounding of coordinates of 40 m is below 1e-14 m.
    EXPECT_NEAR(plan.path.length(), 50.0, Tolerance(1e-12));
    EXPECT_NEAR((plan.path.At(50.0).pose.position() - to).norm(), 0.0, Tolerance(1e-12));
    EXPECT_EQ(plan.stop_distance, plan.path.length());
  }
}

TEST(PlanFillets, RefusesFewerThanTwoWaypoints) {
  ExpectRefused(PlanWith({{0, 0}}, RadiusConstraint::kSteeringRoom), PlanStatus::kTooFewWaypoints,
                0, "1 waypoints; must be at least 2");
  ExpectRefused(PlanWith({}, RadiusConstraint::kSteeringRoom), PlanStatus::kTooFewWaypoints, -1,
                "0 waypoints");
}

TEST(PlanFillets, RefusesDuplicateWaypoints) {
  ExpectRefused(
      PlanWith({{0, 0}, {40, 0}, {40, 40}, {40, 40}, {80, 40}}, RadiusConstraint::kSteeringRoom),
      PlanStatus::kDuplicateWaypoints, 3, "waypoint 3 is the same point as waypoint 2, (40, 40)");
}

TEST(PlanFillets, RefusesUTurn) {
  ExpectRefused(PlanWith({{0, 0}, {40, 0}, {40, 40}, {40, 10}}, RadiusConstraint::kHalfLeg),
                PlanStatus::kUTurn, 2, "turns back on itself at waypoint 2");
}

TEST(PlanFillets, RefusesTurnThatIsTooTight) {
  for (const RadiusConstraint constraint :
       {RadiusConstraint::kHalfLeg, RadiusConstraint::kSteeringRoom}) {
    // At a right angle, a radius of 5.1 m needs 5.1 m of each leg. Half of the shorter leg of 10 m
    // is 5 m.
    ExpectRefused(PlanWith({{0, 0}, {60, 0}, {60, 60}, {50, 60}}, constraint),
                  PlanStatus::kTurnTooTight, 2,
                  "turn of 90 deg at waypoint 2: radius 5.1 m needs 5.1 m of each leg; half of the "
                  "shorter leg is 5 m");
  }
}

TEST(PlanFillets, RefusesNearlyAUTurnAsTooTight) {
  const std::vector<Vec2> route{{0, 0}, {40, 0}, {0, 0.01}};
  ExpectRefused(PlanWith(route, RadiusConstraint::kHalfLeg), PlanStatus::kTurnTooTight, 1,
                "waypoint 1");
}

TEST(PlanFillets, RefusesRadiusBelowTheCars) {
  ExpectRefused(PlanGiven(RouteA(), 5.0), PlanStatus::kTurnTooTight, 1,
                "radius 5 m is below the minimum turning radius of 5.1 m");
  FilletOptions options;
  options.max_radius = 5.0;
  ExpectRefused(PlanFillets(ReferenceCar(), RouteA(), kSpeed, options), PlanStatus::kTurnTooTight,
                1, "the largest radius allowed, 5 m, is below the minimum turning radius of 5.1 m");
}

TEST(PlanFillets, RefusesRightTurnWithItsSign) {
  ExpectRefused(PlanWith({{0, 0}, {60, 0}, {60, -5}}, RadiusConstraint::kHalfLeg),
                PlanStatus::kTurnTooTight, 1, "turn of -90 deg at waypoint 1");
}

TEST(PlanFillets, RefusesLegsWithoutSteeringRoom) {
  // For a turn of 90 degrees and a leg of 28 m, no radius is feasible. For the legs of 60 m of the
  // previous turn, some radii are feasible.
  FilletOptions options;
  options.without_room = InfeasibleTurnPolicy::kRefuse;
  const std::vector<Vec2> route{{0, 0}, {60, 0}, {60, 60}, {88, 60}};
  ExpectRefused(PlanFillets(ReferenceCar(), route, kSpeed, options), PlanStatus::kNoRoomForSteering,
                2,
                "turn of -90 deg at waypoint 2: at 3 m/s no radius from 5.1 to 154 m leaves room "
                "for the steering ramp within half of the shorter leg, 14 m; set "
                "plan.without_room: slow_down, make its legs at least 28.67 m long, or use "
                "plan.method: dubins");
}

// --- A turn for which C.40 has no feasible radius ------------------------------------------------

TEST(PlanFillets, SlowsDownForATurnWithoutRoomAndNoOther) {
  const std::vector<Vec2> route{{0, 0}, {60, 0}, {60, 60}, {88, 60}};
  const FilletPlan plan = PlanFillets(ReferenceCar(), route, kSpeed, {});
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  EXPECT_EQ(plan.turns[0].speed, kSpeed);
  EXPECT_EQ(plan.turns[0].note, "");
  const FilletTurn& slow = plan.turns[1];
  EXPECT_THAT(slow.note, HasSubstr("at 3 m/s no radius from 5.1 to 154 m"));
  EXPECT_THAT(slow.note, HasSubstr(fmt::format("speed reduced to {:.4g} m/s", slow.speed)));
  // At the highest feasible speed v, the minimum of g is zero. For a right angle, the minimum is at
  // the radius r = sqrt(K0 L - L^2), with K0 = v x 17.6/2.65. At this radius, r + K0 atan(L/r)
  // equals half of the leg, 14 m.
  const double per_radian = slow.speed * 17.6 / 2.65;
  EXPECT_NEAR(slow.radius, std::sqrt(per_radian * 2.7 - 2.7 * 2.7), Tolerance(1e-5));
  EXPECT_NEAR(slow.radius + per_radian * std::atan(2.7 / slow.radius), 14.0, Tolerance(1e-9));
  // At a slightly higher speed no radius is feasible. At a slightly lower speed an interval of
  // radii is feasible.
  const RadiusInterval bounds{5.1, 154.0};
  const double phi = kPi / 2.0;
  EXPECT_FALSE(SteeringRoomRadii(ReferenceCar(), slow.speed * (1.0 + 1e-9), phi, 28.0, bounds));
  const auto slower =
      SteeringRoomRadii(ReferenceCar(), slow.speed * (1.0 - 1e-9), phi, 28.0, bounds);
  ASSERT_TRUE(slower);
  EXPECT_LT(slower->low, slower->high);
}

TEST(PlanFillets, TakesNoTurnFasterBecauseItsLegIsShorter) {
  // At full lock, a right angle needs K = 5.1 m and a ramp of S = 3.234 s x v. The speed decreases
  // with the leg and reaches 0.5 m/s at a leg of 13.434 m, half of which is 5.1 + 1.617 m. With
  // only half of the ramp on the leg, 0.5 m/s is possible down to a leg of 2 (5.1 + 0.8085) =
  // 11.817 m. Shorter legs have no plan.
  const auto plan = [](double leg) {
    return PlanFillets(ReferenceCar(), {{0, 0}, {60, 0}, {60, leg}}, kSpeed, {});
  };
  EXPECT_GT(plan(13.5).turns.at(0).speed, 0.5);
  double slowest = kSpeed;
  for (double leg = 40.0; leg > 11.83; leg -= 0.1) {
    const FilletPlan found = plan(leg);
    ASSERT_EQ(found.status, PlanStatus::kOk) << leg << ": " << found.reason;
    EXPECT_LE(found.turns[0].speed, slowest + Tolerance(1e-9)) << leg;
    EXPECT_GE(found.turns[0].speed, 0.5) << leg;
    slowest = found.turns[0].speed;
  }
  EXPECT_EQ(slowest, 0.5);
  EXPECT_THAT(plan(13.4).turns.at(0).note, HasSubstr("speed reduced to 0.5 m/s, half of the ramp"));
  EXPECT_EQ(plan(11.8).status, PlanStatus::kNoRoomForSteering);
  EXPECT_THAT(plan(11.8).reason, HasSubstr("make its legs at least 11.82 m long"));
}

TEST(PlanFillets, KeepsItsSpeedUnderHalfLegWhenAskedTo) {
  FilletOptions options;
  options.without_room = InfeasibleTurnPolicy::kHalfLeg;
  const FilletPlan plan = PlanFillets(ReferenceCar(), {{0, 0}, {60, 0}, {60, 28}}, kSpeed, options);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  EXPECT_EQ(plan.turns[0].speed, kSpeed);
  EXPECT_NEAR(plan.turns[0].radius, 14.0, Tolerance(kRounding));
  EXPECT_THAT(plan.turns[0].note, HasSubstr("14 m; under half_leg instead"));
}

TEST(PlanFillets, TurnsTheWheelsNearThePath) {
  // The route has a sharp corner with long legs. Under constraint C.40 alone, the car could drive
  // at 4.68 m/s at full lock, but then the ramp would be 15.1 m long, longer than the arc of 12.6
  // m.
  const std::vector<Vec2> route{{0, 0}, {59.37, 0}, {-1.5, 48.6}, {117.75, 40}};
  const FilletPlan plan = PlanFillets(ReferenceCar(), route, 7.19, {});
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  for (const FilletTurn& turn : plan.turns) {
    SCOPED_TRACE(turn.waypoint);
    EXPECT_LT(turn.speed, 7.19);
    EXPECT_FALSE(turn.ramp_truncated);
    EXPECT_THAT(turn.note, HasSubstr("the wheels turn too slowly for a radius of"));
    // The planner chooses the highest speed at which the ramp deviates from the path by at most a
    // quarter of the car's width. The radius is the largest that C.40 allows for this speed. The
    // planner finds the speed and the radius as roots, to 52 bits.
    const double S = turn.ramp_distance;
    EXPECT_NEAR(S * S / (24.0 * turn.radius), 0.25 * ReferenceCar().width, Tolerance(1e-9));
    EXPECT_NEAR(turn.tangent_length + S, 0.5 * turn.shorter_leg, Tolerance(1e-9));
  }
  FilletOptions options;
  options.without_room = InfeasibleTurnPolicy::kRefuse;
  EXPECT_EQ(PlanFillets(ReferenceCar(), route, 4.0, options).turns.at(0).speed, 4.0);
}

TEST(PlanFillets, SlowerCarFindsSteeringRoom) {
  const std::vector<Vec2> route{{0, 0}, {60, 0}, {60, 60}, {88, 60}};
  const FilletPlan plan = PlanFillets(ReferenceCar(), route, 1.5, {});
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  EXPECT_EQ(plan.turns[1].speed, 1.5);
}

// --- The listing's own distances -----------------------------------------------------------------

/// The distances of listing F.1, with its defect: after the first turn, the listing still uses the
/// ramp of the first turn.
struct LiteralEvents {
  std::vector<double> start;         ///< Stations D_{2k-1} at the start of a turn [m].
  std::vector<double> end;           ///< Stations D_2k at the return of the steering [m].
  std::vector<double> return_until;  ///< Ends of the windows of the returns [m].
  double route_end = 0.0;            ///< Station D_0 [m]: half of the first turn's ramp before the
                                     ///< goal.
};

LiteralEvents FindLiteralEvents(const FilletPlan& plan) {
  LiteralEvents events;
  const double carried = 0.5 * plan.turns.front().ramp_distance;
  for (const FilletTurn& turn : plan.turns) {
    events.start.push_back(turn.arc_start_s - carried);
    events.end.push_back(events.start.back() + turn.arc_length);
    events.return_until.push_back(events.end.back() + turn.arc_length);
  }
  events.route_end = plan.path.length() - carried;
  return events;
}

TEST(LiteralEvents, AreAsPrinted) {
  // The expected distances D_1 to D_6 and D_0_1 come from a run of listing F.1 in Octave. All of
  // them use the ramp of turn 1.
  struct Case {
    FilletPlan plan;
    std::vector<double> events;
    std::vector<double> until;
    double end;
  };
  const std::vector<Case> cases{{PlanGiven(RouteA(), 5.1),
                                 {30.0494, 38.0604, 67.8604, 75.8715, 105.6715, 113.6826},
                                 {},
                                 148.5826},
                                {PlanGiven(RouteB(), 5.1),
                                 {23.6052, 26.6040, 58.3860, 63.3982, 97.5168, 103.1633},
                                 {},
                                 144.7326},
                                {PlanWith(RouteA(), RadiusConstraint::kHalfLeg),
                                 {18.6632, 50.0791, 50.0791, 81.4950, 81.4950, 112.9110},
                                 {81.4950, 112.9110, 144.3269},
                                 132.9110},
                                {PlanWith(RouteB(), RadiusConstraint::kHalfLeg),
                                 {14.4576, 43.5882, 46.6160, 79.7215, 81.6938, 117.5219},
                                 {},
                                 142.2432}};
  for (const Case& c : cases) {
    const LiteralEvents literal = FindLiteralEvents(c.plan);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(literal.start[k], c.events[2 * k], Tolerance(Printed(4))) << "D_" << 2 * k + 1;
      EXPECT_NEAR(literal.end[k], c.events[2 * k + 1], Tolerance(Printed(4))) << "D_" << 2 * k + 2;
      if (!c.until.empty()) {
        EXPECT_NEAR(literal.return_until[k], c.until[k], Tolerance(Printed(4))) << "window " << k;
      }
    }
    EXPECT_NEAR(literal.route_end, c.end, Tolerance(Printed(4)));
  }
}

TEST(PlanFillets, RefusesArcsThatNeedMoreThanTheirLeg) {
  // At right angles, a radius of 25 m has the tangent length K = 25 m. Two tangents exceed the leg
  // of 40 m by 10 m.
  ExpectRefused(PlanGiven(RouteA(), 25.0), PlanStatus::kTurnsOverlap, 2,
                "the arcs before waypoint 2 exceed their leg by 10 m");
  ExpectRefused(PlanGiven({{0, 0}, {20, 0}, {20, 60}}, 25.0), PlanStatus::kTurnsOverlap, 1,
                "the arcs before waypoint 1 exceed their leg by 5 m");
  ExpectRefused(PlanGiven({{0, 0}, {60, 0}, {60, 20}}, 25.0), PlanStatus::kTurnsOverlap, 2,
                "the arcs before waypoint 2 exceed their leg by 5 m");
}

TEST(PlanFillets, RefusesTurnThatWouldSteerBeforeTheOneBeforeIt) {
  // A gentle turn of 0.01 rad (r = 154 m, S = 0.35 m) is 5.9 m before a turn of 60 degrees (r =
  // 5.109 m, S = 9.69 m). The starts of the two arcs are 0.77 + 2.95 m apart. Half of the second
  // ramp is longer than half of the first ramp by 4.67 m, so the second ramp would begin before the
  // first ramp.
  const Vec2 b = Vec2{40, 0} + 5.9 * Direction(0.01);
  const Vec2 c = b + 40.0 * Direction(0.01 + kPi / 3.0);
  ExpectRefused(PlanWith({{0, 0}, {40, 0}, b, c}, RadiusConstraint::kHalfLeg),
                PlanStatus::kTurnsOverlap, 2, "before that of the previous turn");
}

TEST(PlanFillets, RefusesToSteerBeforeTheStart) {
  // The arc begins at 8 - 5.1 = 2.9 m, and half of the ramp is 9.7012/2 = 4.8506 m long.
  ExpectRefused(
      PlanGiven({{0, 0}, {8, 0}, {8, 60}}, 5.1), PlanStatus::kSteersBeforeStart, 1,
      "the steering for the turn at waypoint 1 would have to start 1.951 m before the route");
}

TEST(PlanFillets, RefusedPlanHasNoPath) {
  const FilletPlan plan = PlanGiven({{0, 0}, {8, 0}, {8, 60}}, 5.1);
  ASSERT_NE(plan.status, PlanStatus::kOk);
  EXPECT_TRUE(plan.schedule.knots().empty());
}

TEST(PlanFillets, ChecksItsCaller) {
  EXPECT_THROW(PlanFillets(ReferenceCar(), RouteA(), 0.0, {}), InternalError);
  EXPECT_THROW(PlanWith(RouteA(), RadiusConstraint::kNone), InternalError);
  EXPECT_THROW(PlanWith({{0, 0}, {std::nan(""), 0}, {40, 40}}, RadiusConstraint::kHalfLeg),
               InternalError);
}

// --- Open-loop runs of the plans ---------------------------------------------------------------

/// Rolls out a plan over `distance` [m]. The reference point of the car starts at the first
/// waypoint.
KinematicState Drive(const std::vector<Vec2>& route, const FilletPlan& plan, double distance,
                     ReferencePoint reference, double step) {
  const Vec2 leg = route[1] - route[0];
  const KinematicState start{.pose = {route[0].x(), route[0].y(), std::atan2(leg.y(), leg.x())},
                             .speed = kSpeed};
  return RollOut(ReferenceCar(), start, plan.schedule, distance, step, reference);
}

constexpr ReferencePoint kRear = ReferencePoint::kRearAxle;
constexpr ReferencePoint kCg = ReferencePoint::kCenterOfGravity;
constexpr double kStep = 0.1;  // [m]

TEST(OpenLoop, PassOneStopsShortOfFullLock) {
  // On half of the arc of 8.0111 m, the steering angle rises with the slope omega/v to 0.4021 rad,
  // less than the angle of full lock, 0.4869 rad.
  const FilletPlan plan = PlanGiven(RouteA(), 5.1);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  double peak = 0.0;
  for (const SteeringSchedule::Knot& knot : plan.schedule.knots()) {
    peak = std::max(peak, std::abs(knot.steering));
  }
  EXPECT_NEAR(peak, 5.1 * kPi / 2.0 * (2.65 / 17.6) / kSpeed, Tolerance(kRounding));
  EXPECT_NEAR(peak, 0.4021, Tolerance(Printed(4)));
}

TEST(OpenLoop, PassOneYawIsTheClosedFormOfATruncatedTurn) {
  // On two ramps up to the steering angle delta_p, the heading changes by 2 (v/(L omega)) (-ln cos
  // delta_p). When the wheels begin to return, half of this change is complete.
  const FilletPlan plan = PlanGiven(RouteA(), 5.1);
  const double peak = 5.1 * kPi / 2.0 * (2.65 / 17.6) / kSpeed;
  const double ramp = kSpeed * 17.6 / (2.7 * 2.65) * -std::log(std::cos(peak));
  const auto at_return = Drive(RouteA(), plan, plan.turns[0].steer_return, kRear, kStep);
  const auto at_end = Drive(RouteA(), plan, plan.path.length(), kRear, kStep);
  // The roll-out is a method of fourth order with steps of 0.1 m. The heading error of the roll-out
  // on a ramp of the length S is h^4 |psi'''''| S/2880 < 1e-9 rad.
  EXPECT_NEAR(at_return.pose.yaw, ramp, Tolerance(1e-9));
  EXPECT_NEAR(at_end.pose.yaw, 2.0 * ramp, Tolerance(3e-9));
}

struct YawCase {
  const char* name;
  std::vector<Vec2> route;
  ReferencePoint reference;
  std::vector<double> yaw_at_return;  // [rad]
  int decimals;
  double final_yaw;  // [deg]
};

void PrintTo(const YawCase& c, std::ostream* out) {
  *out << c.name;
}

class OpenLoopYaw : public ::testing::TestWithParam<YawCase> {};

TEST_P(OpenLoopYaw, IsAsPrinted) {
  const YawCase& c = GetParam();
  const FilletPlan plan = PlanGiven(c.route, 5.1);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  for (std::size_t k = 0; k < plan.turns.size(); ++k) {
    const double distance = plan.turns[k].steer_return;
    const double yaw = Drive(c.route, plan, distance, c.reference, kStep).pose.yaw;
    EXPECT_NEAR(yaw, c.yaw_at_return[k], Tolerance(Printed(c.decimals))) << "turn " << k + 1;
    EXPECT_NEAR(yaw, Drive(c.route, plan, distance, c.reference, 0.5 * kStep).pose.yaw,
                Tolerance(1e-8));
  }
  const double yaw = Drive(c.route, plan, plan.path.length(), c.reference, kStep).pose.yaw;
  EXPECT_NEAR(Degrees(yaw), c.final_yaw, Tolerance(Printed(4)));
  EXPECT_NEAR(yaw, Drive(c.route, plan, plan.path.length(), c.reference, 0.5 * kStep).pose.yaw,
              Tolerance(1e-8));
}

INSTANTIATE_TEST_SUITE_P(
    Section46, OpenLoopYaw,
    ::testing::Values(YawCase{"ARear", RouteA(), kRear, {0.6133, 0.6133, 0.6133}, 4, 70.2771},
                      YawCase{"ACg", RouteA(), kCg, {0.6062, 0.6062, 0.6062}, 4, 69.4659},
                      YawCase{"BRear", RouteB(), kRear, {0.08390, 0.40380, 0.33943}, 5, 2.2372},
                      YawCase{"BCg", RouteB(), kCg, {0.08377, 0.40252, 0.33878}, 5, 2.2961}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(OpenLoop, PassOneOnRouteAEndsFarFromTheGoal) {
  const FilletPlan plan = PlanGiven(RouteA(), 5.1);
  const KinematicState end = Drive(RouteA(), plan, plan.path.length(), kRear, kStep);
  EXPECT_NEAR(end.pose.x, 105.3, Tolerance(Printed(1)));
  EXPECT_NEAR(end.pose.y, 75.3, Tolerance(Printed(1)));
}

struct EndCase {
  const char* name;
  std::vector<Vec2> route;
  FilletOptions options;
  ReferencePoint reference;
  double error;  // [m]
  int decimals;
};

FilletOptions Chosen(RadiusConstraint constraint) {
  FilletOptions options;
  options.constraint = constraint;
  return options;
}

FilletOptions Given(double radius) {
  FilletOptions options;
  options.radius = radius;
  options.constraint = RadiusConstraint::kNone;
  return options;
}

void PrintTo(const EndCase& c, std::ostream* out) {
  *out << c.name;
}

class OpenLoopEnd : public ::testing::TestWithParam<EndCase> {};

TEST_P(OpenLoopEnd, MissesTheGoalAsPrinted) {
  const EndCase& c = GetParam();
  const FilletPlan plan = PlanFillets(ReferenceCar(), c.route, kSpeed, c.options);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  const auto error = [&](double step) {
    const Pose2 end = Drive(c.route, plan, plan.path.length(), c.reference, step).pose;
    return (end.position() - c.route.back()).norm();
  };
  RecordProperty("error_m", fmt::format("{:.10f}", error(0.25 * kStep)));
  EXPECT_NEAR(error(kStep), c.error, Tolerance(Printed(c.decimals)));
  // The result has converged: halving the step changes the error by less than a thousandth of the
  // smallest tolerance above.
  EXPECT_NEAR(error(kStep), error(0.5 * kStep), Tolerance(5e-8));
}

INSTANTIATE_TEST_SUITE_P(
    Section49, OpenLoopEnd,
    ::testing::Values(
        EndCase{"AHalfLegRear", RouteA(), Chosen(RadiusConstraint::kHalfLeg), kRear, 3.767, 3},
        EndCase{"AHalfLegCg", RouteA(), Chosen(RadiusConstraint::kHalfLeg), kCg, 5.519, 3},
        EndCase{"ARoomRear", RouteA(), Chosen(RadiusConstraint::kSteeringRoom), kRear, 0.1285, 4},
        EndCase{"ARoomCg", RouteA(), Chosen(RadiusConstraint::kSteeringRoom), kCg, 1.642, 3},
        EndCase{"ATurnLocalRear", RouteA(), Given(13.0626), kRear, 0.305, 3},
        EndCase{"ATurnLocalCg", RouteA(), Given(13.1407), kCg, 1.425, 3},
        EndCase{"BHalfLegRear", RouteB(), Chosen(RadiusConstraint::kHalfLeg), kRear, 0.0076, 4},
        EndCase{"BHalfLegCg", RouteB(), Chosen(RadiusConstraint::kHalfLeg), kCg, 0.575, 3},
        EndCase{"BRoomRear", RouteB(), Chosen(RadiusConstraint::kSteeringRoom), kRear, 0.0104, 4},
        EndCase{"BRoomCg", RouteB(), Chosen(RadiusConstraint::kSteeringRoom), kCg, 0.566, 3}),
    [](const auto& test) { return std::string(test.param.name); });

// An arc of radius r misses the corner of two legs at right angles by r (sqrt 2 - 1).
TEST(WaypointMiss, LimitsTheRadius) {
  const std::vector<Vec2> route{{0, 0}, {60, 0}, {60, 60}};
  const double unit = std::sqrt(2.0) - 1.0;
  const FilletPlan near = PlanNear(route, 3.0);
  ASSERT_EQ(near.status, PlanStatus::kOk) << near.reason;
  EXPECT_NEAR(near.turns[0].radius, 3.0 / unit, Tolerance(kRounding));
  EXPECT_EQ(near.turns[0].active, ActiveConstraint::kWaypointMiss);
  // With a large bound, another constraint determines the radius, as without a bound.
  const FilletPlan far = PlanNear(route, 1000.0);
  EXPECT_EQ(far.turns[0].radius, PlanWith(route, RadiusConstraint::kSteeringRoom).turns[0].radius);
  EXPECT_NE(far.turns[0].active, ActiveConstraint::kWaypointMiss);
}

TEST(WaypointMiss, RefusesRadiiThatAreTooLarge) {
  const std::vector<Vec2> route{{0, 0}, {60, 0}, {60, 60}};
  // An arc with the car's smallest radius, 5.1 m, misses the waypoint by 2.112 m, and an arc with a
  // radius of 10 m misses it by 4.142 m.
  const FilletPlan smallest = PlanNear(route, 2.0);
  EXPECT_EQ(smallest.status, PlanStatus::kWaypointMissed);
  EXPECT_EQ(smallest.waypoint, 1);
  EXPECT_THAT(smallest.reason, HasSubstr("missed by 2.112 m, more than 2 m"));
  EXPECT_THAT(smallest.reason, HasSubstr("set plan.max_waypoint_miss to at least 2.12,"));
  EXPECT_EQ(PlanNear(route, 2.12).status, PlanStatus::kOk);
  const FilletPlan given = PlanNear(route, 4.0, 10.0);
  EXPECT_EQ(given.status, PlanStatus::kWaypointMissed);
  EXPECT_THAT(given.reason, HasSubstr("missed by 4.142 m, more than 4 m"));
}

// The bound that a refusal names must be sufficient, so it is that of the sharpest turn. If a turn
// has no room, no bound is sufficient, and the refusal names the turn.
TEST(WaypointMiss, IsNotTheReasonIfNoBoundHelps) {
  const std::vector<Vec2> sharper_later{{0, 0}, {60, 0}, {60, 60}, {20, 0}};
  const FilletPlan missed = PlanNear(sharper_later, 2.0);
  EXPECT_EQ(missed.status, PlanStatus::kWaypointMissed);
  EXPECT_EQ(missed.waypoint, 2);
  // The second turn has the interior angle 90 deg - atan(60/40). An arc with the car's smallest
  // radius, 5.1 m, misses it by 5.1 (1/sin(33.69 deg/2) - 1) = 12.50 m.
  EXPECT_THAT(missed.reason, HasSubstr("missed by 12.5 m, more than 2 m"));
  EXPECT_EQ(PlanNear(sharper_later, 12.6).status, PlanStatus::kOk);
  const FilletPlan tight = PlanNear({{0, 0}, {48.8, 0}, {46.23, -5.64}, {-14.29, 119.86}}, 2.0);
  EXPECT_EQ(tight.status, PlanStatus::kTurnTooTight);
  EXPECT_EQ(tight.waypoint, 1);
}

TEST(OpenLoop, MirroredPlanDrivesMirrored) {
  std::vector<Vec2> mirrored = RouteB();
  for (Vec2& w : mirrored) {
    w.y() = -w.y();
  }
  for (const ReferencePoint reference : {kRear, kCg}) {
    const FilletPlan a = PlanWith(RouteB(), RadiusConstraint::kSteeringRoom);
    const FilletPlan b = PlanWith(mirrored, RadiusConstraint::kSteeringRoom);
    const Pose2 left = Drive(RouteB(), a, a.path.length(), reference, kStep).pose;
    const Pose2 right = Drive(mirrored, b, b.path.length(), reference, kStep).pose;
    // The tolerance allows for rounding in 1500 steps at coordinates of 100 m, by 1.4e-14 m in each
    // step.
    EXPECT_NEAR(right.x, left.x, Tolerance(1e-10));
    EXPECT_NEAR(right.y, -left.y, Tolerance(1e-10));
    EXPECT_NEAR(right.yaw, -left.yaw, Tolerance(1e-10));
  }
}

}  // namespace fillet_test
}  // namespace trackbed
