#include "trackbed/planning/common/speed_at_limit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace speed_at_limit_test {

constexpr double kGrip = 8.0;  // [m/s^2]

PlanRequest Request() {
  PlanRequest request;
  request.vehicle.name = "car";
  request.vehicle.wheelbase = 2.5;
  request.vehicle.cg_to_rear = 1.0;
  request.vehicle.steering_limit = 0.6;
  request.vehicle.steering_rate = 0.5;
  request.vehicle.length = 4.0;
  request.vehicle.width = 1.8;
  request.speed = {.speed = 30.0, .acceleration = 1.0, .deceleration = 1.5};
  request.limits = SpeedAtLimit{
      GgvDiagram({.mass = 1000.0, .rolling_mass = 1000.0}, {EllipticSection(kGrip, kGrip, kGrip)}),
      {.share = 1.0}};
  return request;
}

/// Returns a plan along a path from the origin, with the speed profile that SetSpeeds computes.
Plan PlanAlong(std::vector<Segment> segments, const PlanRequest& request) {
  Plan plan;
  plan.reference.path = Path({}, std::move(segments));
  SetSpeeds(plan, request.start_speed, request.speed);
  return plan;
}

/// Returns a straight of 60 m, a clothoid of 30 m, an arc of radius 40 m and length 60 m, a second
/// clothoid of 30 m, and a straight of 60 m.
std::vector<Segment> Bend() {
  return {{.length = 60.0},
          {.length = 30.0, .sharpness = 1.0 / 1200.0},
          {.length = 60.0, .curvature = 1.0 / 40.0},
          {.length = 30.0, .curvature = 1.0 / 40.0, .sharpness = -1.0 / 1200.0},
          {.length = 60.0}};
}

TEST(SpeedAtLimit, IsThatOfFrictionInABend) {
  const PlanRequest request = Request();
  const Plan plan = MakeFeasible(PlanAlong(Bend(), request), request);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const SpeedProfile& speed = plan.reference.speed;
  EXPECT_EQ(speed.SpeedAt(0.0), 0.0);
  EXPECT_EQ(speed.SpeedAt(240.0), 0.0);
  EXPECT_NEAR(speed.SpeedAt(120.0), std::sqrt(kGrip * 40.0), Tolerance(1e-4));
  // From rest, the car accelerates with full grip until the bend limits its speed.
  EXPECT_NEAR(speed.SpeedAt(10.0), std::sqrt(2.0 * kGrip * 10.0), Tolerance(1e-3));
  ASSERT_TRUE(plan.diagnostics.speed_profile);
  EXPECT_NEAR(plan.diagnostics.speed_profile->predicted_time, speed.TimeAt(240.0), Tolerance(1e-9));
  EXPECT_NEAR(plan.diagnostics.speed_profile->lateral_max, kGrip, Tolerance(1e-4));
  EXPECT_EQ(plan.notes.size(), 1U);
}

TEST(SpeedAtLimit, KeepsTheSteeringRate) {
  // On the clothoid, the curvature rate kappa' is 1/1200 1/m^2. The steering rate requires v L
  // kappa'/(1 + (L kappa)^2) <= omega. This limit is lowest at the start of the clothoid, where
  // kappa = 0.
  PlanRequest request = Request();
  request.vehicle.steering_rate = 0.02;
  const Plan plan = MakeFeasible(PlanAlong(Bend(), request), request);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const double cap = 0.02 / (2.5 / 1200.0);  // 9.6 m/s
  EXPECT_NEAR(plan.reference.speed.SpeedAt(60.0), cap, Tolerance(1e-3 * cap));
  for (const Excess& excess : FindExcesses(plan, request)) {
    EXPECT_EQ(excess.what.find("steering rate"), std::string::npos) << ToString(excess);
  }
}

TEST(SpeedAtLimit, KeepsTheSteeringRateOnTyres) {
  // A car with linear tyres needs the steering angle tan(delta) = kappa (L + K v^2) on a path with
  // the curvature kappa. The steering rate therefore also depends on the change of the speed.
  // Steering rates from differences over 0.05 m have an error below 1 %.
  PlanRequest request = Request();
  request.vehicle.mass = 1000.0;
  request.vehicle.yaw_inertia = 1500.0;
  request.vehicle.cornering_stiffness_front = 50e3;
  request.vehicle.cornering_stiffness_rear = 90e3;
  request.limits->options.share = 0.9;
  const double gradient = 1000.0 / 2.5 * (1.0 / 50e3 - 1.5 / 90e3);
  for (const double rate : {0.015, 0.03, 0.05}) {
    request.vehicle.steering_rate = rate;
    const Plan plan = MakeFeasible(PlanAlong(Bend(), request), request);
    ASSERT_TRUE(plan.ok()) << plan.reason;
    const SpeedProfile& speed = plan.reference.speed;
    const auto steering = [&](double s) {
      const double v = speed.SpeedAt(s);
      return std::atan(plan.reference.path.At(s).curvature * (2.5 + gradient * v * v));
    };
    double fastest = 0.0;
    for (double s = 55.0; s < 185.0; s += 0.05) {
      const double time = speed.TimeAt(s + 0.05) - speed.TimeAt(s);
      fastest = std::max(fastest, std::abs(steering(s + 0.05) - steering(s)) / time);
    }
    EXPECT_LT(fastest, 1.01 * 0.9 * rate);
    EXPECT_GT(fastest, 0.9 * 0.9 * rate) << "needlessly slow";
  }
}

TEST(SpeedAtLimit, StopsAtCuspsAndStops) {
  const PlanRequest request = Request();
  Plan plan = PlanAlong({{.length = 20.0}, {.length = 10.0, .direction = -1}}, request);
  plan = MakeFeasible(plan, request);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_EQ(plan.reference.speed.SpeedAt(20.0), 0.0);
  EXPECT_NEAR(plan.reference.speed.SpeedAt(10.0), std::sqrt(2.0 * kGrip * 10.0), Tolerance(1e-3));
  Plan stops = PlanAlong({{.length = 40.0}}, request);
  stops.stops = {15.0};
  stops = MakeFeasible(stops, request);
  ASSERT_TRUE(stops.ok()) << stops.reason;
  EXPECT_EQ(stops.reference.speed.SpeedAt(15.0), 0.0);
  EXPECT_GT(stops.reference.speed.SpeedAt(16.0), 3.0);
}

TEST(SpeedAtLimit, DrivesPartsThatAreShorterThanTheSpacing) {
  // From rest to rest over the distance d = 0.2 m, the car needs the time 2 sqrt(d/a) at the
  // acceleration a.
  const PlanRequest request = Request();
  Plan plan = PlanAlong({{.length = 0.2}, {.length = 0.2, .direction = -1}}, request);
  plan = MakeFeasible(plan, request);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_NEAR(plan.reference.speed.TimeAt(0.4), 4.0 * std::sqrt(0.2 / kGrip), Tolerance(1e-3));
}

TEST(SpeedAtLimit, KeepsCapsOfThePlanAndTheMissionsSpeed) {
  PlanRequest request = Request();
  request.speed.speed = 12.0;
  Plan plan = PlanAlong({{.length = 200.0}}, request);
  plan.caps = {{100.0, 110.2, 4.0}};
  plan = MakeFeasible(plan, request);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  for (double s = 100.0; s <= 110.2; s += 0.05) {
    EXPECT_LE(plan.reference.speed.SpeedAt(s), 4.0 + Tolerance(1e-9)) << s;
  }
  EXPECT_NEAR(plan.reference.speed.SpeedAt(60.0), 12.0, Tolerance(1e-9));
}

TEST(SpeedAtLimit, KnowsRoadAndSlopes) {
  PlanRequest request = Request();
  request.friction_patches = {{{{30.0, 0.0, 0.0}, 20.0, 4.0}, 0.25}};
  request.limits->ground.grade = {0.1, -0.05};
  const Path path({}, {{.length = 60.0}});
  const std::vector<LimitStation> stations = StationsAlong(path, {0.0, 60.0}, request, {});
  EXPECT_EQ(stations.front().s, 0.0);
  EXPECT_EQ(stations.back().s, 60.0);
  for (const LimitStation& at : stations) {
    // The tolerances allow for rounding of heights of some meters, whose differences over 1.25 m
    // give the slopes.
    EXPECT_NEAR(at.grade, 0.1, Tolerance(1e-14));
    EXPECT_NEAR(at.bank, -0.05, Tolerance(1e-15));
    EXPECT_NEAR(at.crest, 0.0, Tolerance(1e-14));
    // The ice reaches from 20 to 40 m, and the wheelbase is 2.5 m. From 17.5 to 40 m, at least one
    // axle is on the ice.
    const bool on_ice = at.s >= 17.5 && at.s <= 40.0;
    EXPECT_EQ(at.road, on_ice ? 0.25 : 1.0) << at.s;
  }
}

TEST(SpeedAtLimit, RefusesAStartThatIsTooFast) {
  PlanRequest request = Request();
  request.start_speed = 30.0;
  request.speed.speed = 30.0;
  const std::vector<Segment> sharp{{.length = 20.0}, {.length = 30.0, .curvature = 1.0 / 20.0}};
  Plan plan = PlanAlong(sharp, request);
  const Plan refused = MakeFeasible(plan, request);
  EXPECT_EQ(refused.status, PlanStatus::kInfeasible);
  EXPECT_NE(refused.reason.find("speed 24.1 m/s exceeds 12.6 m/s at s = 20 m"), std::string::npos)
      << refused.reason;
  request.infeasible = InfeasiblePolicy::kAllow;
  const Plan kept = MakeFeasible(plan, request);
  EXPECT_TRUE(kept.ok());
  EXPECT_EQ(kept.notes.size(), 2U);
}

// On ice with the friction factor 0.25, the tyres hold 2 m/s^2. Gravity on a slope of 1 in 2 pulls
// with 4.4 m/s^2.
TEST(SpeedAtLimit, RefusesASlopeThatTheCarCannotHold) {
  PlanRequest request = Request();
  request.friction = 0.25;
  request.limits->ground.grade = {0.5, 0.0};
  request.start_speed = 5.0;
  Plan plan = PlanAlong({{.length = 60.0}}, request);
  const Plan refused = MakeFeasible(plan, request);
  EXPECT_EQ(refused.status, PlanStatus::kInfeasible);
  EXPECT_NE(refused.reason.find("speed 0.1 m/s exceeds 0 m/s"), std::string::npos)
      << refused.reason;
  request.infeasible = InfeasiblePolicy::kAllow;
  const Plan kept = MakeFeasible(plan, request);
  for (const std::string& note : kept.notes) {
    EXPECT_EQ(note.find("inf s"), std::string::npos) << note;
  }
}

TEST(SpeedAtLimit, RefusesAPathThatIsTooTight) {
  const PlanRequest request = Request();
  const Plan refused =
      MakeFeasible(PlanAlong({{.length = 10.0, .curvature = 0.5}}, request), request);
  EXPECT_EQ(refused.status, PlanStatus::kInfeasible);
  EXPECT_NE(refused.reason.find("steering angle"), std::string::npos) << refused.reason;
}

}  // namespace speed_at_limit_test
}  // namespace trackbed
