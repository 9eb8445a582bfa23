#include "trackbed/control/mpc.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/control/loop.h"
#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/lqr.h"
#include "trackbed/control/steering_controller.h"

namespace trackbed {
namespace {

double Steer(const ControllerOptions& options, const VehicleParams& vehicle,
             const Reference& reference, const VehicleState& state, double station, double period) {
  return MakeSteeringController(options)->Steer({.vehicle = vehicle,
                                                 .reference = reference,
                                                 .schedule = {},
                                                 .state = state,
                                                 .station = station,
                                                 .period = period});
}

TEST(Mpc, IsTheRegulatorWhereNoLimitIsInTheWay) {
  // lqr and mpc have the same model and cost. lqr solves a Riccati recursion, mpc a condensed
  // quadratic program. Angles are below 0.1 rad, and Cholesky decompositions have condition numbers
  // below 1e4.
  Random random(91);
  const double period = 0.1;
  for (int i = 0; i < 100; ++i) {
    VehicleParams car = i % 2 == 0 ? ReferenceCar() : ReferenceCarWithTyres();
    car.steering_rate = 1e6;  // the regulator sees ramps instead of steps of the curvature
    car.steering_limit = 1.5;
    const int direction = i % 5 == 0 ? -1 : 1;
    const double speed = direction * random.Uniform(1.0, 25.0);
    SCOPED_TRACE(fmt::format("case {}: {} m/s", i, speed));
    std::vector<Segment> segments;
    for (int k = 0; k < 12; ++k) {
      segments.push_back({.length = random.Uniform(2.0, 12.0),
                          .curvature = random.Uniform(-0.02, 0.02),
                          .direction = direction,
                          .sharpness = random.Uniform(-1e-3, 1e-3)});
    }
    const Reference reference{Path({}, segments), {}};
    const double station = random.Uniform(0.0, 20.0);
    VehicleState state;
    state.pose = Compose(reference.path.At(station).pose,
                         {0.0, random.Uniform(-0.2, 0.2), random.Uniform(-0.05, 0.05)});
    state.speed = speed;
    state.steering_actuator = random.Uniform(-0.05, 0.05);
    state.steering = random.Uniform(-0.05, 0.05);
    state.lateral_speed = random.Uniform(-0.1, 0.1);
    state.yaw_rate = random.Uniform(-0.1, 0.1);
    const double mpc =
        Steer(MpcOptions{.cross_track = 1.0, .steering_rate = 1.0, .horizon = 20, .step = period},
              car, reference, state, station, period);
    const double lqr =
        Steer(LqrOptions{.cross_track = 1.0, .steering_rate = 1.0, .preview = 20 * period}, car,
              reference, state, station, period);
    EXPECT_NEAR(mpc, lqr, Tolerance(1e-9));
  }
}

TEST(Mpc, TurnsTheWheelsAsEarlyAsTheirRateNeeds) {
  // The path has a curvature step of 0.1 1/m, which is a steering angle of 0.264 rad. These wheels
  // need 3.3 s to reach it. Both controllers look 4 s ahead in the same steps, but only the MPC
  // knows that the wheels are slow.
  LoopSetup setup;
  setup.vehicle.steering_rate = 0.08;
  setup.path = Path({}, {{30.0, 0.0, 1}, {15.0, 0.1, 1}, {100.0, 0.0, 1}});
  setup.duration = 30.0;
  setup.period = 0.1;
  const double mpc = LargestOffset(Loop(MpcOptions{.horizon = 40, .step = 0.1}, setup));
  const double lqr = LargestOffset(Loop(LqrOptions{.preview = 4.0}, setup));
  EXPECT_LT(mpc, 0.8 * lqr);
}

/// Returns the angle that mpc commands to a car on a straight path, `way` [m] before a circle.
double SteerBeforeCircle(const MpcOptions& options, const SpeedProfile& planned, double way) {
  const VehicleParams car = ReferenceCarWithTyres();
  const Reference reference{Path({}, {{way, 0.0, 1}, {100.0, 0.05, 1}}), planned};
  VehicleState state;
  state.speed = planned.SpeedAt(0.0);
  return Steer(options, car, reference, state, 0.0, 0.02);
}

TEST(Mpc, PredictsWithThePlannedSpeed) {
  // From 12 to 2 m/s over 28 m, the car drives for 4 s. The circle begins 10 m later, after 9 s,
  // but after 3.2 s at the present speed. Within 4 s, no deviation needs a command.
  const SpeedProfile braking({{0.0, 12.0}, {28.0, 2.0}, {100.0, 2.0}});
  const MpcOptions options{.horizon = 40, .step = 0.1};
  EXPECT_EQ(SteerBeforeCircle(options, braking, 38.0), 0.0);
  EXPECT_NE(SteerBeforeCircle(options, SpeedProfile({{0.0, 12.0}}), 38.0), 0.0);
}

TEST(Mpc, LooksAheadForTheTimeOfTheWheelsToTheirLimit) {
  // The wheels turn to their limit in 0.487 rad / (0.1506 rad/s) = 3.2 s; the circle begins after
  // 3 s. Twenty steps of 0.1 s end before the circle.
  const SpeedProfile speed({{0.0, 4.0}});
  EXPECT_EQ(SteerBeforeCircle({.step = 0.1}, speed, 12.0), 0.0);
  EXPECT_NE(SteerBeforeCircle({}, speed, 12.0), 0.0);
}

TEST(Mpc, KeepsTheWheelsTurnedUpToTheEnd) {
  // The path ends on a bend, 1 m ahead. The car stops there with turned wheels, so that it need not
  // straighten them for the straight tangent beyond the end. The same holds for lqr.
  const VehicleParams car = ReferenceCar();
  const Reference reference{Path({}, {{20.0, 0.1, 1}}), SpeedProfile({{0.0, 1.0}})};
  VehicleState state;
  state.pose = reference.path.At(19.0).pose;
  state.speed = 1.0;
  state.steering = SteeringForCurvature(car, 0.1);
  state.steering_actuator = state.steering;
  const std::vector<ControllerOptions> both{MpcOptions{}, LqrOptions{}};
  for (const ControllerOptions& options : both) {
    EXPECT_NEAR(Steer(options, car, reference, state, 19.0, 0.02), state.steering, Tolerance(1e-9));
  }
}

TEST(Mpc, ComesBackFromFarAway) {
  LoopSetup setup;
  setup.path = Path({}, {{300.0, 0.0, 1}});
  setup.start = {0.0, 20.0, 0.0};
  setup.duration = 60.0;
  const std::vector<LoopRow> rows = Loop(MpcOptions{}, setup);
  EXPECT_LT(LargestOffset(rows, rows.size() * 9 / 10), 0.05);
}

TEST(Mpc, KeepsRateAndAngle) {
  LoopSetup setup;
  setup.path = Path({}, {{30.0, 0.0, 1}, {12.0, 0.19, 1}, {100.0, 0.0, 1}});
  setup.start = {0.0, 1.5, 0.3};
  setup.duration = 30.0;
  const double most = ReferenceCar().steering_rate * setup.period;
  double before = 0.0;
  bool at_rate = false;
  for (const LoopRow& row : Loop(MpcOptions{}, setup)) {
    EXPECT_LE(std::abs(row.wanted - before), most + Tolerance(1e-12));
    EXPECT_LE(std::abs(row.wanted), ReferenceCar().steering_limit);
    at_rate = at_rate || std::abs(std::abs(row.wanted - before) - most) < 1e-9;
    before = row.wanted;
  }
  EXPECT_TRUE(at_rate);
}

TEST(Mpc, SmallLimitsAreKeptByThePlanToo) {
  // The circle with a curvature of 0.01 1/m needs 0.027 rad, but the steering limit of the car is
  // 0.02 rad. mpc commands exactly the limit.
  VehicleParams car = ReferenceCar();
  car.steering_limit = 0.02;
  LoopSetup setup;
  setup.vehicle = car;
  setup.path = Path({}, {{20.0, 0.0, 1}, {100.0, 0.01, 1}});
  const std::vector<LoopRow> rows = Loop(MpcOptions{}, setup);
  EXPECT_NEAR(rows.back().wanted, 0.02, Tolerance(1e-9));
}

}  // namespace
}  // namespace trackbed
