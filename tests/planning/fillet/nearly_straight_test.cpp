#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/planning/routes.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/fillet/fillet.h"

// Waypoints that lie nearly on a line, at any distance from each other: as closely as a turn
// permits, and closer.
namespace trackbed {
namespace nearly_straight_test {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Distance per speed and steering angle that the reference car drives while its wheels turn [s].
constexpr double kPerRadian = 17.6 / 2.65;
constexpr double kAxles = 2.7;  // wheelbase [m]

/// Returns the part of each leg that a turn needs at a speed: the least r tan(h/2) + S over a dense
/// scan of radii r [m], with the ramp S = v/omega_delta atan(L/r).
double ScannedRoom(double heading_change, double speed) {
  double least = std::numeric_limits<double>::infinity();
  constexpr int kRadii = 2000;
  for (int i = 0; i <= kRadii; ++i) {
    const double radius = 5.1 * std::pow(1e7, static_cast<double>(i) / kRadii);
    least = std::min(least, radius * std::tan(0.5 * heading_change) +
                                speed * kPerRadian * std::atan(kAxles / radius));
  }
  return least;
}

/// Returns a route of two legs of a length [m] with a turn [rad] between them.
std::vector<Vec2> TwoLegs(double leg, double heading_change) {
  return {{0.0, 0.0},
          {leg, 0.0},
          {leg + leg * std::cos(heading_change), leg * std::sin(heading_change)}};
}

// For large radii, r h/2 + v k L/r is least at r = sqrt(2 v k L/h), where both parts are equal,
// with k = 1/omega_delta. The sum equals half of the leg q at the speed v = q^2/(8 k L h). The
// error of atan(L/r) = L/r is at most (L/r)^2/3 = 3e-6 for r > 900 m.
TEST(NearlyStraight, TakesALargerRadiusWhereARampNeedsIt) {
  constexpr double kLeg = 0.04;   // [m]
  constexpr double kTurn = 2e-5;  // [rad]
  const FilletPlan plan = PlanFillets(ReferenceCar(), TwoLegs(kLeg, kTurn), 3.0, {});
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  ASSERT_EQ(plan.turns.size(), 1U);
  EXPECT_THAT(plan.left_out, IsEmpty());
  const double speed = kLeg * kLeg / (8.0 * kPerRadian * kAxles * kTurn);
  EXPECT_NEAR(plan.turns[0].speed, speed, Tolerance(1e-5));
  const double radius = std::sqrt(2.0 * speed * kPerRadian * kAxles / kTurn);
  EXPECT_GT(radius, 900.0);
  EXPECT_NEAR(plan.turns[0].radius, radius, Tolerance(1e-4 * radius));
  EXPECT_EQ(plan.turns[0].active, ActiveConstraint::kSteeringRoom);
}

// A turn of 1e-6 rad on legs of 4 cm has room at the mission's speed with a radius of 10 km.
TEST(NearlyStraight, KeepsItsSpeedWhereALargerRadiusHasRoom) {
  const FilletPlan plan = PlanFillets(ReferenceCar(), TwoLegs(0.04, 1e-6), 3.0, {});
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  EXPECT_EQ(plan.turns.at(0).speed, 3.0);
  EXPECT_GT(plan.turns.at(0).radius, 154.0);
}

// Points every 5 cm, of which one is 1 mm beside the line: the turns of 0.02 and 0.04 rad need 5.1
// tan(0.02) = 0.1 m of legs, which have 0.025 m.
TEST(NearlyStraight, LeavesOutAPointBesideTheLine) {
  std::vector<Vec2> route;
  for (int i = 0; i < 40; ++i) {
    route.emplace_back(0.05 * i, i == 20 ? 0.001 : 0.0);
  }
  const FilletPlan plan = PlanFillets(ReferenceCar(), route, 3.0, {});
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  EXPECT_THAT(plan.left_out, ElementsAre(20));
  EXPECT_THAT(plan.turns, IsEmpty());
  EXPECT_NEAR(plan.path.length(), 0.05 * 39, Tolerance(1e-12));
  // The smallest arc passes the first turn of 0.02 rad at 5.1 x 0.02^2/8 = 0.26 mm. A bound of
  // that size would not help: the arc's tangents of 51 mm have no room on legs of 50 mm.
  FilletOptions exact;
  exact.max_waypoint_miss = 0.0001;
  const FilletPlan refused = PlanFillets(ReferenceCar(), route, 3.0, exact);
  EXPECT_EQ(refused.status, PlanStatus::kTurnTooTight);
  EXPECT_EQ(refused.waypoint, 19);
}

TEST(NearlyStraight, KeepsAPointWhereTheTurnBesideItWouldBeTooSharp) {
  // Route 1575 of the audit: three legs of 2 m and two turns of 0.078 rad. At 0.5 m/s, each turn
  // needs 0.83 m of its legs. Without the second turn, the first one of 0.117 rad needs 1.01 m.
  const std::vector<Vec2> route{{-48.00919313, -52.78445836},
                                {-46.09328124, -53.35828900},
                                {-44.22794924, -54.07977118},
                                {-42.42455668, -54.94451119}};
  const double speed = 1.5659;
  EXPECT_LT(ScannedRoom(0.0781, 0.25), 1.0);
  const FilletPlan plan = PlanFillets(ReferenceCar(), route, speed, {});
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  EXPECT_THAT(plan.left_out, IsEmpty());
}

TEST(NearlyStraight, KeepsPointsFarBesideTheLine) {
  // The second turn has no room, and no route without its waypoint passes it within a quarter of
  // the car's width.
  const std::vector<Vec2> route{{0, 0}, {60, 0}, {60, 60}, {50, 60}};
  const FilletPlan plan = PlanFillets(ReferenceCar(), route, 3.0, {});
  EXPECT_EQ(plan.status, PlanStatus::kTurnTooTight);
  EXPECT_EQ(plan.waypoint, 2);
}

/// Points on a line at any distances, rounded to a digit.
std::vector<Vec2> RoundedLine(Random& random, double digit) {
  const double heading = random.Uniform(-kPi, kPi);
  const double spacing = std::pow(10.0, random.Uniform(-3.0, 3.0));
  const int count = 3 + static_cast<int>(random.Below(6));
  std::vector<Vec2> route;
  double s = 0.0;
  for (int i = 0; i < count; ++i) {
    const Vec2 at(std::round(s * std::cos(heading) / digit) * digit,
                  std::round(s * std::sin(heading) / digit) * digit);
    if (route.empty() || at != route.back()) {
      route.push_back(at);
    }
    s += spacing * (random.Below(2) == 0 ? random.Uniform(0.8, 1.2)
                                         : std::pow(10.0, random.Uniform(-1.0, 1.0)));
  }
  return route;
}

/// Whether a single turn fits at a speed [m/s] that begins in the direction of the first leg,
/// halfway to the goal, if half of a leg has at most `most` [m] of room and waypoints are at most
/// `aside` [m] beside the legs.
bool FitsOneTurn(const std::vector<Vec2>& route, double speed, double most, double aside) {
  const Vec2 first = (route[1] - route[0]).normalized();
  const Vec2 corner = route[0] + 0.5 * (route.back() - route[0]).norm() * first;
  const Vec2 out = route.back() - corner;
  const double turn =
      std::abs(std::atan2(first.x() * out.y() - first.y() * out.x(), first.dot(out)));
  const double room = 0.5 * std::min((corner - route[0]).norm(), out.norm());
  const auto distance = [](const Vec2& at, const Vec2& from, const Vec2& along) {
    const double share = std::clamp((at - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (at - from - share * along).norm();
  };
  for (const Vec2& at : route) {
    if (std::min(distance(at, route[0], corner - route[0]), distance(at, corner, out)) > aside) {
      return false;
    }
  }
  // The path may have to turn up to four times as sharply, on legs half as long, because it tries
  // lengths of the first leg that differ by a factor of 1.9.
  return ScannedRoom(4.0 * turn, speed) < std::min(0.25 * room, most);
}

TEST(NearlyStraight, IsPlannedAtAnyDistanceOfThePoints) {
  Random random(20261126);
  int planned = 0;
  int left_out = 0;
  int fast = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const double digit = std::pow(10.0, random.Uniform(-6.0, -1.0));
    const std::vector<Vec2> route = RoundedLine(random, digit);
    if (route.size() < 2 || (route.back() - route.front()).norm() < 20.0 * digit) {
      continue;
    }
    const double speed = random.Below(2) == 0 ? 0.5 : random.Uniform(2.0, 10.0);
    const FilletPlan plan = PlanFillets(ReferenceCar(), route, speed, {});
    if (plan.status != PlanStatus::kOk) {
      EXPECT_FALSE(FitsOneTurn(route, 0.25, 1e9, 0.1)) << "trial " << trial << ": " << plan.reason;
      continue;
    }
    // The planner tries first legs of up to two turning radii, so a turn has at least a quarter of
    // this. It slows down for no turn that it can avoid by leaving out waypoints within a sixteenth
    // of the car's width.
    if (FitsOneTurn(route, speed, 0.5 * 5.1, 0.9 / 16.0 * ReferenceCar().width)) {
      ++fast;
      for (const FilletTurn& turn : plan.turns) {
        EXPECT_GE(turn.speed, speed - 1e-9) << "trial " << trial << ", waypoint " << turn.waypoint;
      }
    }
    ++planned;
    left_out += plan.left_out.empty() ? 0 : 1;
    double wide = 0.0;  // largest distance of an arc from its corner [m]
    for (const FilletTurn& turn : plan.turns) {
      wide = std::max(wide, turn.radius * (1.0 / std::cos(0.5 * turn.heading_change) - 1.0));
    }
    for (const Vec2& at : route) {
      const double s = plan.path.Project({at.x(), at.y(), 0.0}, {0.0, plan.path.length()}).s;
      EXPECT_LT((plan.path.At(s).pose.position() - at).norm(),
                0.25 * ReferenceCar().width + wide + 1e-9)
          << "trial " << trial;
    }
    const Vec2 end = plan.path.At(plan.path.length()).pose.position();
    // Each of at most seven turns of less than 1e-9 rad that the planner ignores moves the end.
    EXPECT_LT((end - route.back()).norm(), 1e-9 + 7e-9 * plan.path.length()) << "trial " << trial;
  }
  EXPECT_GT(planned, 600);
  EXPECT_GT(left_out, 30);
  EXPECT_GT(fast, 200);
}

// At 10 m/s, the turns at waypoints 2 and 3 have room for 0.5 m/s.
TEST(NearlyStraight, DoesNotSlowDownForRoundingToCentimeters) {
  const FilletPlan plan = PlanFillets(
      ReferenceCar(), {{0, 0}, {8.02, 0}, {9.87, 0}, {10.35, -0.01}, {39.7, 0.02}}, 10.0, {});
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  for (const FilletTurn& turn : plan.turns) {
    EXPECT_EQ(turn.speed, 10.0) << "waypoint " << turn.waypoint;
  }
  EXPECT_THAT(plan.left_out, ::testing::Not(IsEmpty()));
}

TEST(NearlyStraight, LeavesOutAPointThatWasClickedTwice) {
  // The second click is the goal, less than half a meter from the first. No turn fits between them,
  // so the path turns on the first leg instead, and leaves out waypoint 1.
  for (const Vec2& apart : {Vec2(0.3, 0.2), Vec2(0.0, 0.2), Vec2(-0.2, -0.1)}) {
    const std::vector<Vec2> route{{0, 0}, {10, 0}, Vec2(10, 0) + apart};
    FilletOptions options;
    options.without_room = InfeasibleTurnPolicy::kSlowDown;
    const FilletPlan plan = PlanFillets(ReferenceCar(), route, 3.0, options);
    ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
    EXPECT_THAT(plan.left_out, ElementsAre(1));
    EXPECT_LE(plan.path.length(), 10.0 + apart.norm());
    const Vec2 end = plan.path.At(plan.path.length()).pose.position();
    EXPECT_NEAR((end - route.back()).norm(), 0.0, Tolerance(1e-9));
  }
}

TEST(ShortLegs, AreRefusedWithARemedyThatWorks) {
  // A turn by 90 degrees of radius r needs r of each leg, so half of the leg of 8 m fits 4 m.
  const std::vector<Vec2> route{{0, 0}, {40, 0}, {40, 8}};
  FilletOptions options;
  const FilletPlan tight = PlanFillets(ReferenceCar(), route, 1.0, options);
  ASSERT_EQ(tight.status, PlanStatus::kTurnTooTight);
  EXPECT_THAT(tight.reason, ::testing::HasSubstr("make its legs at least 10.21 m long"));
  options.constraint = RadiusConstraint::kHalfLeg;
  EXPECT_EQ(PlanFillets(ReferenceCar(), {{0, 0}, {40, 0}, {40, 10.21}}, 1.0, options).status,
            PlanStatus::kOk);
  // With a given radius, a smaller one is the remedy.
  options.radius = 9.0;
  const std::vector<Vec2> longer{{0, 0}, {40, 0}, {40, 12}};
  const FilletPlan wide = PlanFillets(ReferenceCar(), longer, 1.0, options);
  ASSERT_EQ(wide.status, PlanStatus::kTurnTooTight);
  EXPECT_THAT(wide.reason, ::testing::HasSubstr("set plan.radius to at most "));
  options.radius = 5.999;
  EXPECT_EQ(PlanFillets(ReferenceCar(), longer, 1.0, options).status, PlanStatus::kOk);
}

}  // namespace nearly_straight_test
}  // namespace trackbed
