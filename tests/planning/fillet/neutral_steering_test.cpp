#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/planning/routes.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/planning/fillet/steering_room.h"
#include "trackbed/planning/registry/planners.h"

// Tests fillet plans of a car whose wheels are at the neutral steering angle d_0 between its turns.
namespace trackbed {
namespace neutral_steering_test {

using testing::HasSubstr;

constexpr double kSpeed = 3.0;
constexpr double kRate = 2.65 / 17.6;  // [rad/s]
constexpr double kWheelbase = 2.7;     // [m]

// Rounding error [m] of some ten operations on distances up to 200 m. Each operation has an error
// of 200 x 2^-53 = 2.2e-14 m.
constexpr double kRounding = 1e-12;

FilletOptions Neutral(double steering) {
  FilletOptions options;
  options.neutral_steering = steering;
  return options;
}

PlanRequest Request(const std::vector<Vec2>& waypoints) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.waypoints = waypoints;
  request.start_speed = kSpeed;
  request.speed = {.speed = kSpeed, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

TEST(NeutralSteering, RampsTakeTheTravelFromItAndBack) {
  for (const double neutral : {0.02, -0.02}) {
    const FilletPlan plan = PlanFillets(ReferenceCar(), RouteA(), kSpeed, Neutral(neutral));
    ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
    ASSERT_EQ(plan.turns.size(), 3U);
    EXPECT_EQ(plan.schedule.At(0.0), neutral);
    for (const FilletTurn& turn : plan.turns) {
      const double side = turn.heading_change > 0.0 ? 1.0 : -1.0;
      const double steering = side * std::atan(kWheelbase / turn.radius);
      const double time = std::abs(steering - neutral) / kRate;
      EXPECT_NEAR(turn.steering, steering, Tolerance(kRounding));
      EXPECT_NEAR(turn.ramp_time, time, Tolerance(kRounding));
      // The ramp is centered on the tangent point: half of the ramp lies before this point, and
      // half behind it.
      EXPECT_NEAR(turn.steer_start, turn.arc_start_s - 0.5 * kSpeed * time, Tolerance(kRounding));
      EXPECT_NEAR(plan.schedule.At(turn.steer_start), neutral, Tolerance(kRounding));
      EXPECT_NEAR(plan.schedule.At(turn.arc_start_s), 0.5 * (steering + neutral),
                  Tolerance(kRounding));
      EXPECT_NEAR(plan.schedule.At(turn.steer_return), steering, Tolerance(kRounding));
      EXPECT_NEAR(plan.schedule.At(turn.steer_return + kSpeed * time), neutral,
                  Tolerance(kRounding));
    }
  }
}

TEST(NeutralSteering, LeavesTheRoomThatItsOwnRampsNeed) {
  // The legs are 40 m long, and the turns differ only in their side. Constraint C.40 with ramps of
  // |delta - d_0| requires K + S = 20 m.
  const FilletPlan plan = PlanFillets(ReferenceCar(), RouteA(), kSpeed, Neutral(0.02));
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  for (const FilletTurn& turn : plan.turns) {
    EXPECT_EQ(turn.active, ActiveConstraint::kSteeringRoom);
    EXPECT_NEAR(turn.tangent_length + turn.ramp_distance, 20.0, Tolerance(kRounding));
  }
  // A turn to the side opposite to the neutral angle has a longer ramp, and therefore a smaller
  // radius.
  EXPECT_LT(plan.turns[1].radius, plan.turns[0].radius);
}

TEST(NeutralSteering, RadiiAgreeWithADenseScan) {
  Random random(20240607);
  int intervals = 0;
  int beyond = 0;  // The number of intervals with radii larger than that of the circle driven at
                   // d_0.
  for (int i = 0; i < 400; ++i) {
    const double angle = Radians(random.Uniform(20.0, 178.0));
    const double leg = random.Uniform(3.0, 60.0);
    const double speed = random.Uniform(0.5, 5.0);
    const double neutral = random.Uniform(-0.3, 0.3);
    SCOPED_TRACE(
        fmt::format("case {}: phi = {}, q = {}, v = {}, d_0 = {}", i, angle, leg, speed, neutral));
    const RadiusInterval bounds{5.1, 154.0};
    const auto g = [&](double r) {
      return r / std::tan(angle / 2.0) +
             speed * std::abs(std::atan(kWheelbase / r) - neutral) / kRate - leg / 2.0;
    };
    const auto radii = SteeringRoomRadii(ReferenceCar(), speed, angle, leg, bounds, neutral);
    constexpr int kPoints = 4000;
    for (int j = 0; j <= kPoints; ++j) {
      const double r = bounds.low * std::pow(bounds.high / bounds.low, j / double{kPoints});
      // The terms of g are below 1000 m. If |g| is below 1e-11 m, rounding may change the sign of
      // g.
      if (radii && r >= radii->low && r <= radii->high) {
        ASSERT_LE(g(r), 1e-11) << "r = " << r;
      } else {
        ASSERT_GE(g(r), -1e-11) << "r = " << r;
      }
    }
    if (radii) {
      ++intervals;
      beyond += neutral > 0.0 && radii->high > kWheelbase / std::tan(neutral) ? 1 : 0;
    }
  }
  EXPECT_GT(intervals, 100);
  EXPECT_LT(intervals, 350);
  EXPECT_GT(beyond, 10);
}

TEST(NeutralSteering, MirroredRouteAndAngleGiveTheMirroredPlan) {
  std::vector<Vec2> mirrored = RouteB();
  for (Vec2& w : mirrored) {
    w.y() = -w.y();
  }
  const FilletPlan a = PlanFillets(ReferenceCar(), RouteB(), kSpeed, Neutral(0.03));
  const FilletPlan b = PlanFillets(ReferenceCar(), mirrored, kSpeed, Neutral(-0.03));
  ASSERT_EQ(a.status, PlanStatus::kOk) << a.reason;
  ASSERT_EQ(b.status, PlanStatus::kOk) << b.reason;
  for (std::size_t k = 0; k < a.turns.size(); ++k) {
    EXPECT_NEAR(a.turns[k].radius, b.turns[k].radius, Tolerance(kRounding));
    EXPECT_NEAR(a.turns[k].steer_start, b.turns[k].steer_start, Tolerance(kRounding));
  }
  EXPECT_NEAR(a.verification.goal_heading, -b.verification.goal_heading, Tolerance(kRounding));
  EXPECT_NEAR(a.verification.deviation_max, b.verification.deviation_max, Tolerance(kRounding));
}

TEST(NeutralSteering, PredictionOfAStraightRouteIsTheCircleThatTheWheelsDrive) {
  const std::vector<Vec2> straight{{0, 0}, {20, 0}, {40, 0}};
  const FilletPlan plan = PlanFillets(ReferenceCar(), straight, kSpeed, Neutral(0.05));
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  const double curvature = std::tan(0.05) / kWheelbase;
  const double yaw = 40.0 * curvature;
  const Vec2 end(std::sin(yaw) / curvature, (1.0 - std::cos(yaw)) / curvature);
  // With constant steering, the roll-out is Simpson's rule with steps of 0.5 m. The position error
  // of the roll-out over 40 m is (0.5 kappa)^4/2880 x 40 m = 1e-10 m.
  EXPECT_NEAR(plan.verification.goal_distance, (end - straight.back()).norm(), Tolerance(1e-9));
  EXPECT_NEAR(plan.verification.goal_heading, yaw, Tolerance(kRounding));
}

TEST(NeutralSteering, PredictedHeadingIsTheIntegralOverRampsAndHolds) {
  // The heading is psi = int tan(delta)/L ds. Outside the turn, the curvature is kappa_0. Between
  // the two ramps, the curvature is that of the arc. A ramp with the slope m from the neutral
  // steering angle d_0 to delta turns the car by (ln cos d_0 - ln cos delta)/(L m).
  const std::vector<Vec2> route{{0, 0}, {40, 0}, {40, 40}};
  for (const double neutral : {0.01, -0.03}) {
    const FilletPlan plan = PlanFillets(ReferenceCar(), route, kSpeed, Neutral(neutral));
    ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
    const double delta = std::atan(kWheelbase / plan.turns[0].radius);
    const double slope = kRate / kSpeed;
    const double ramp = (delta - neutral) / slope;
    const double on_ramp =
        (std::log(std::cos(neutral)) - std::log(std::cos(delta))) / (kWheelbase * slope);
    const double arc = plan.turns[0].radius * kPi / 2.0;
    const double yaw = 2.0 * on_ramp + (arc - ramp) / plan.turns[0].radius +
                       (plan.path.length() - arc - ramp) * std::tan(neutral) / kWheelbase;
    // The roll-out is a method of fourth order, with an error of h^4 |psi'''''| S/2880 < 1e-6 rad
    // for h = 0.5 m.
    EXPECT_NEAR(plan.verification.goal_heading, yaw - kPi / 2.0, Tolerance(1e-6)) << neutral;
  }
}

TEST(NeutralSteering, FindingsTellIt) {
  const Plan plan = MakePlan(Request(RouteA()), Neutral(0.02));
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_EQ(DiagnosticsJson(plan).at("neutral_steering_rad"), 0.02);
  EXPECT_EQ(DiagnosticsJson(plan).at("neutral_curvature_radpm"),
            CurvatureForSteering(ReferenceCar(), 0.02));
  // A steering angle of 0.02 rad over the 17 m before the first turn already causes a heading error
  // of 0.12 rad and an offset of more than 1 m.
  EXPECT_GT(DiagnosticsJson(plan).at("open_loop").at("deviation_max_m"), 1.0);
  // Predictions for single turns assume straight wheels. A plan with a neutral steering angle
  // therefore has no such predictions.
  EXPECT_TRUE(plan.turns.empty());
  EXPECT_FALSE(DiagnosticsJson(plan).at("turns").at(0).contains("predicted"));

  const Plan straight = MakePlan(Request(RouteA()), FilletOptions{});
  EXPECT_FALSE(DiagnosticsJson(straight).contains("neutral_steering_rad"));
}

TEST(NeutralSteering, BeyondTheCarsLimitThereIsNoPlan) {
  const FilletPlan plan = PlanFillets(ReferenceCar(), RouteA(), kSpeed, Neutral(-0.5));
  EXPECT_EQ(plan.status, PlanStatus::kTurnTooTight);
  EXPECT_THAT(plan.reason,
              HasSubstr("neutral_steering -0.5 rad exceeds the steering limit of 0.4869 rad"));
}

TEST(NeutralSteering, EveryObjectivePlansWithIt) {
  for (const RadiusObjective objective : {RadiusObjective::kLargest, RadiusObjective::kLiteral,
                                          RadiusObjective::kTurnLocal, RadiusObjective::kDriven}) {
    FilletOptions options = Neutral(0.002);
    options.objective = objective;
    options.search.method = SearchMethod::kDirect;
    const FilletPlan plan = PlanFillets(ReferenceCar(), RouteB(), kSpeed, options);
    ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
    EXPECT_EQ(plan.schedule.At(0.0), 0.002);
    EXPECT_EQ(plan.schedule.knots().back().steering, 0.002);
  }
}

}  // namespace neutral_steering_test
}  // namespace trackbed
