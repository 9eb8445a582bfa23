#include "trackbed/vehicle/steering_schedule.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

// Tests steering schedules: against the state machine of listing F.1 and printed tables
// (Skackauskas, dissertation), and the roll-out's order of convergence and closed forms.
namespace trackbed {
namespace steering_schedule_test {

constexpr double kSpeed = 3.0;
const double kSlope = ReferenceCar().steering_rate / kSpeed;

// Rounding of angles below 1 rad at distances below 200 m after a few operations, for example 200 *
// slope * 2^-53.
constexpr double kRounding = 1e-14;

// --- The function --------------------------------------------------------------------------------

TEST(SteeringSchedule, IsStraightWithoutTurns) {
  EXPECT_EQ(SteeringSchedule().At(-1.0), 0.0);
  EXPECT_EQ(SteeringSchedule().At(1e6), 0.0);
  EXPECT_EQ(SteeringSchedule({}, kSlope).At(5.0), 0.0);
}

TEST(SteeringSchedule, ConstantHoldsItsAngle) {
  const SteeringSchedule schedule = SteeringSchedule::Constant(-0.2);
  for (const double distance : {-1.0, 0.0, 1e-9, 50.0, 1e6}) {
    EXPECT_EQ(schedule.At(distance), -0.2);
  }
}

TEST(SteeringSchedule, TurnThatFitsIsATrapezoid) {
  for (const double steering : {0.1, -0.1}) {
    const SteeringSchedule schedule({{10.0, 30.0, steering}}, kSlope);
    const double ramp = 0.1 / kSlope;  // 1.99 m
    ASSERT_LT(ramp, 20.0);
    const double sign = std::copysign(1.0, steering);
    EXPECT_EQ(schedule.At(0.0), 0.0);
    EXPECT_EQ(schedule.At(10.0), 0.0);
    EXPECT_NEAR(schedule.At(11.0), sign * kSlope, Tolerance(kRounding));
    EXPECT_NEAR(schedule.At(10.0 + ramp), steering, Tolerance(kRounding));
    EXPECT_NEAR(schedule.At(20.0), steering, Tolerance(kRounding));
    EXPECT_NEAR(schedule.At(30.0), steering, Tolerance(kRounding));
    EXPECT_NEAR(schedule.At(31.0), steering - sign * kSlope, Tolerance(kRounding));
    EXPECT_NEAR(schedule.At(30.0 + ramp), 0.0, Tolerance(kRounding));
    EXPECT_EQ(schedule.At(100.0), 0.0);
    EXPECT_EQ(schedule.knots().size(), 4U);
  }
}

TEST(SteeringSchedule, ShortTurnStaysBelowItsTarget) {
  const SteeringSchedule schedule({{10.0, 14.0, 0.4}}, kSlope);
  EXPECT_NEAR(schedule.At(14.0), 4.0 * kSlope, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(18.0), 0.0, Tolerance(kRounding));
  EXPECT_EQ(schedule.At(20.0), 0.0);
}

TEST(SteeringSchedule, TurnsStartFromTheNeutralAngleAndReturnToIt) {
  const double neutral = 0.02;
  const SteeringSchedule schedule({{10.0, 30.0, 0.1}, {60.0, 80.0, -0.1}}, kSlope, neutral);
  const double left = 0.08 / kSlope;
  const double right = 0.12 / kSlope;
  EXPECT_EQ(schedule.At(0.0), neutral);
  EXPECT_EQ(schedule.At(10.0), neutral);
  EXPECT_NEAR(schedule.At(10.0 + 0.5 * left), 0.06, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(10.0 + left), 0.1, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(30.0 + 0.5 * left), 0.06, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(30.0 + left), neutral, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(60.0), neutral, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(60.0 + right), -0.1, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(80.0 + right), neutral, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(200.0), neutral, Tolerance(kRounding));
  EXPECT_EQ(SteeringSchedule({}, kSlope, neutral).At(5.0), neutral);
}

TEST(SteeringSchedule, TurnTakesOverFromAReturn) {
  // In this S-bend, the second turn starts at the station at which the first turn returns.
  const SteeringSchedule schedule({{10.0, 30.0, 0.1}, {30.0, 50.0, -0.1}}, kSlope);
  const double ramp = 0.1 / kSlope;
  EXPECT_NEAR(schedule.At(30.0), 0.1, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(30.0 + ramp), 0.0, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(30.0 + 2.0 * ramp), -0.1, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(50.0), -0.1, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(50.0 + ramp), 0.0, Tolerance(kRounding));
}

TEST(SteeringSchedule, TurnTakesOverInTheMiddleOfAReturn) {
  const SteeringSchedule schedule({{10.0, 30.0, 0.2}, {31.0, 50.0, 0.3}}, kSlope);
  EXPECT_NEAR(schedule.At(31.0), 0.2 - kSlope, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(32.0), 0.2, Tolerance(kRounding));
}

TEST(SteeringSchedule, LatestTurnEndsAnEarlierOne) {
  const SteeringSchedule schedule({{10.0, 40.0, 0.2}, {20.0, 50.0, -0.2}}, kSlope);
  EXPECT_NEAR(schedule.At(20.0), 0.2, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(20.0 + 0.4 / kSlope), -0.2, Tolerance(kRounding));
  EXPECT_NEAR(schedule.At(45.0), -0.2, Tolerance(kRounding));  // the return at 40 m is skipped
}

/// The reference: the state machine of listing F.1, evaluated in small steps.
double StateMachine(const std::vector<TurnSteering>& turns, double slope, double distance,
                    int steps) {
  double steering = 0.0;
  const double h = distance / steps;
  for (int i = 0; i < steps; ++i) {
    const double middle = (i + 0.5) * h;
    double target = 0.0;
    for (const TurnSteering& turn : turns) {
      if (turn.start <= middle) {
        target = middle < turn.end ? turn.steering : 0.0;  // the turn that started last applies
      }
    }
    steering += std::clamp(target - steering, -slope * h, slope * h);
  }
  return steering;
}

TEST(SteeringSchedule, IsTheStateMachineAndKeepsTheSlope) {
  Random random(11);
  for (int i = 0; i < 100; ++i) {
    std::vector<TurnSteering> turns;
    double start = random.Uniform(0.0, 5.0);
    const int count = 1 + random.Below(5);
    for (int k = 0; k < count; ++k) {
      turns.push_back({start, start + random.Uniform(0.5, 20.0), random.Uniform(-0.48, 0.48)});
      start += random.Uniform(0.1, 20.0);
    }
    std::string text;
    for (const TurnSteering& turn : turns) {
      text += fmt::format(" ({}, {}, {})", turn.start, turn.end, turn.steering);
    }
    SCOPED_TRACE(fmt::format("case {}:{}", i, text));
    const SteeringSchedule schedule(turns, kSlope);
    const auto& knots = schedule.knots();
    for (std::size_t j = 0; j + 1 < knots.size(); ++j) {
      ASSERT_LT(knots[j].distance, knots[j + 1].distance);
      EXPECT_LE(std::abs(knots[j + 1].steering - knots[j].steering),
                kSlope * (knots[j + 1].distance - knots[j].distance) + Tolerance(kRounding));
    }
    EXPECT_EQ(knots.back().steering, 0.0);
    for (int j = 0; j < 10; ++j) {
      const double distance = random.Uniform(0.0, 110.0);
      // StateMachine detects each of at most ten switches up to half a step early or late. Its step
      // is h = 110/20000 m. The target may change sign, so each switch causes an error of up to 2
      // * slope * h/2. The tolerance is 10 * h * slope.
      EXPECT_NEAR(schedule.At(distance), StateMachine(turns, kSlope, distance, 20000),
                  Tolerance(10.0 * 110.0 / 20000.0 * kSlope));
    }
  }
}

TEST(SteeringSchedule, RefusesTurnsOutOfOrder) {
  EXPECT_THROW(SteeringSchedule({{30.0, 40.0, 0.1}, {10.0, 20.0, 0.1}}, kSlope), InternalError);
  EXPECT_THROW(SteeringSchedule({{30.0, 30.0, 0.1}}, kSlope), InternalError);
  EXPECT_THROW(SteeringSchedule({{-1.0, 30.0, 0.1}}, kSlope), InternalError);
  EXPECT_THROW(SteeringSchedule({{1.0, 30.0, 0.1}}, 0.0), InternalError);
}

// --- Closed forms --------------------------------------------------------------------------------

TEST(SteeringDistance, HasThePrintedTable) {
  const std::vector<std::pair<double, double>> table{
      {5.1, 9.7012}, {10.0, 5.2543}, {20.0, 2.6736}, {50.0, 1.0749}, {154.0, 0.3493}};
  for (const auto& [radius, distance] : table) {
    const double steering = SteeringForCurvature(ReferenceCar(), 1.0 / radius);
    EXPECT_NEAR(SteeringDistance(ReferenceCar(), steering, kSpeed), distance, Tolerance(0.5e-4));
    EXPECT_EQ(SteeringDistance(ReferenceCar(), -steering, kSpeed),
              SteeringDistance(ReferenceCar(), steering, kSpeed));
  }
}

TEST(SteeringDistance, FitsIntoTheArcFromThePrintedRadiusOn) {
  // From these radii on, the steering ramp fits into the arc: `spare` changes its sign within the
  // last digit of the radius. The published radius for 120 degrees is 4.841, because the author
  // rounds 4.84045 up.
  const std::vector<std::pair<double, double>> table{
      {30.0, 10.018}, {45.0, 8.132}, {60.0, 7.002}, {90.0, 5.652}, {120.0, 4.840}};
  for (const auto& [degrees, radius] : table) {
    SCOPED_TRACE(degrees);
    const auto spare = [change = degrees * kPi / 180.0](double r) {
      return r * change - SteeringDistance(ReferenceCar(),
                                           SteeringForCurvature(ReferenceCar(), 1.0 / r), kSpeed);
    };
    EXPECT_LT(spare(radius - Tolerance(0.5e-3)), 0.0);
    EXPECT_GT(spare(radius + Tolerance(0.5e-3)), 0.0);
  }
}

/// Heading that a turn lacks [rad, <= 0] if both of its ramps are centered on the tangent points
/// and fit into the arc: (v/(L omega)) (-2 ln cos delta - delta tan delta).
double TurnHeadingDefect(const VehicleParams& params, double steering, double speed) {
  const double scale = speed / (params.wheelbase * params.steering_rate);
  return scale * (-2.0 * std::log(std::cos(steering)) - steering * std::tan(steering));
}

TEST(TurnHeadingDefect, HasThePrintedValues) {
  // The result does not depend on the angle of the turn. At a radius of 5.1 m, the ramps fit only
  // into turns of more than 109 degrees.
  struct Row {
    double radius, degrees, tolerance;
  };
  for (const Row& row :
       {Row{5.1, -4.52, 0.5e-2}, Row{10.0, -0.354, 0.5e-3}, Row{13.0152, -0.126, 0.5e-3},
        Row{16.83, -0.0457, 0.5e-4}, Row{20.0, -0.0231, 0.5e-4}, Row{50.0, -0.0006, 0.5e-4}}) {
    SCOPED_TRACE(row.radius);
    const double steering = SteeringForCurvature(ReferenceCar(), 1.0 / row.radius);
    EXPECT_NEAR(TurnHeadingDefect(ReferenceCar(), steering, kSpeed) * 180.0 / kPi, row.degrees,
                Tolerance(row.tolerance));
    EXPECT_EQ(TurnHeadingDefect(ReferenceCar(), -steering, kSpeed),
              TurnHeadingDefect(ReferenceCar(), steering, kSpeed));
  }
}

TEST(TurnHeadingDefect, IsOfFourthOrder) {
  // The heading defect has the series -2 ln cos d - d tan d = -d^4/6 - 4 d^6/45 - .... For the
  // steering angle d below 0.1 rad, the second term of this series is at most 0.54 % of the first
  // term, and the third term is ten times smaller than the second.
  const double scale = kSpeed / (2.7 * ReferenceCar().steering_rate);
  for (const double steering : {0.02, 0.05, 0.1}) {
    const double first = -scale * std::pow(steering, 4) / 6.0;
    EXPECT_NEAR(TurnHeadingDefect(ReferenceCar(), steering, kSpeed), first,
                Tolerance(0.6 * steering * steering * std::abs(first)));
  }
}

KinematicState Start() {
  return {.pose = {}, .speed = kSpeed};
}

TEST(RampHeading, IsWhatTheCarTurnsOnItsRamp) {
  for (const double steering : {0.05, 0.134189, -0.263712, 0.486899}) {
    SCOPED_TRACE(steering);
    const double ramp = SteeringDistance(ReferenceCar(), steering, kSpeed);
    const SteeringSchedule schedule({{0.0, 100.0, steering}}, kSlope);
    const KinematicState end = RollOut(ReferenceCar(), Start(), schedule, ramp, 0.05);
    // RollOut integrates the curvature tan(delta)/L with Simpson's rule. The error of the heading
    // is h^4/2880 |d^4/ds^4 tan(delta)/L| S, with the step h = 0.05 m and the length S = 9.7 m.
    // With tan'''' <= 60 at 0.487 rad and slope^4 = 6.3e-6, the error is 6.25e-6/2880 * 60/2.7 *
    // 6.3e-6 * 9.7 = 3e-12 rad.
    EXPECT_NEAR(end.pose.yaw, RampHeading(ReferenceCar(), steering, kSpeed), Tolerance(1e-11));
    EXPECT_NEAR(end.steering, steering, Tolerance(kRounding));
  }
  EXPECT_EQ(RampHeading(ReferenceCar(), 0.0, kSpeed), 0.0);
}

TEST(RollOut, MissesTheArcsHeadingByTheDefect) {
  for (const double radius : {10.0, 16.83, -20.0}) {
    SCOPED_TRACE(radius);
    const double steering = SteeringForCurvature(ReferenceCar(), 1.0 / radius);
    const double arc = std::abs(radius) * kPi / 2.0;
    const SteeringSchedule schedule({{5.0, 5.0 + arc, steering}}, kSlope);
    const double yaw = RollOut(ReferenceCar(), Start(), schedule, 60.0, 0.05).pose.yaw;
    EXPECT_NEAR(std::abs(yaw), kPi / 2.0 + TurnHeadingDefect(ReferenceCar(), steering, kSpeed),
                Tolerance(1e-11));
    EXPECT_EQ(std::signbit(yaw), std::signbit(radius));
  }
}

TEST(RollOut, TruncatedTurnTurnsSeventyDegrees) {
  // In a turn of 90 degrees with a radius of 5.1 m, the steering angle reaches only 0.4021 rad, and
  // the car turns by only 70.2771 degrees.
  const double arc = 5.1 * kPi / 2.0;
  const SteeringSchedule schedule({{5.0, 5.0 + arc, ReferenceCar().steering_limit}}, kSlope);
  const KinematicState peak = RollOut(ReferenceCar(), Start(), schedule, 5.0 + arc, 0.05);
  EXPECT_NEAR(peak.steering, 0.4021, Tolerance(0.5e-4));
  EXPECT_NEAR(peak.steering, kSlope * arc, Tolerance(kRounding));
  const KinematicState end = RollOut(ReferenceCar(), Start(), schedule, 40.0, 0.05);
  EXPECT_NEAR(end.pose.yaw * 180.0 / kPi, 70.2771, Tolerance(0.5e-4));
  EXPECT_NEAR(end.pose.yaw, 2.0 * RampHeading(ReferenceCar(), kSlope * arc, kSpeed),
              Tolerance(1e-11));
  EXPECT_NEAR(
      RollOut(ReferenceCar(), Start(), schedule, 40.0, 0.05, ReferencePoint::kCenterOfGravity)
              .pose.yaw *
          180.0 / kPi,
      69.4659, Tolerance(0.5e-4));
}

TEST(RollOut, DrivesTheDistance) {
  const SteeringSchedule schedule({{1.0, 7.3, 0.3}}, kSlope);
  const KinematicState end = RollOut(ReferenceCar(), Start(), schedule, 23.7, 0.11);
  EXPECT_NEAR(end.distance, 23.7, Tolerance(1e-12));  // 220 sums, each rounded by 2e-15
  EXPECT_EQ(end.speed, kSpeed);
}

TEST(RollOut, IsOfFourthOrder) {
  // Halving the step of a fourth-order method divides the error by 16. The bound of 10 leaves room
  // for the next order.
  const SteeringSchedule schedule({{5.0, 20.0, 0.4}, {25.0, 40.0, -0.4}}, kSlope);
  for (const ReferencePoint reference :
       {ReferencePoint::kRearAxle, ReferencePoint::kCenterOfGravity}) {
    const auto end = [&](double step) {
      return RollOut(ReferenceCar(), Start(), schedule, 60.0, step, reference).pose.position();
    };
    const Vec2 exact = end(0.02);
    const double coarse = (end(2.0) - exact).norm();
    const double fine = (end(1.0) - exact).norm();
    EXPECT_GT(coarse, 1e-7);
    EXPECT_LT(fine, coarse / 10.0);
  }
}

TEST(RollOut, ChecksItsCaller) {
  EXPECT_THROW(RollOut(ReferenceCar(), {}, SteeringSchedule(), 1.0, 0.1), InternalError);
  EXPECT_THROW(RollOut(ReferenceCar(), Start(), SteeringSchedule(), 1.0, 0.0), InternalError);
}

TEST(SteeringSchedule, ValueAtTheEndOfThePeriodDrivesTheScheduleAtAnyPeriod) {
  // The controller commands the schedule's value at the end of each period. If a ramp begins inside
  // a period T, after the fraction f of the period, the wheels start f T too early. The heading
  // errs by v/L * omega f (1 - f) T^2 <= v omega T^2/(4 L). Apart from this error, the motion is
  // exact. Two ramp starts cause twice this error, and the position errs by at most the heading
  // error times the distance.
  const VehicleParams car = ReferenceCar();
  const double distance = 60.0;
  const SteeringSchedule schedule({{10.013, 30.007, SteeringForCurvature(car, 1.0 / 16.830685)}},
                                  kSlope);
  const KinematicState exact = RollOut(car, Start(), schedule, distance, 0.01);
  for (int milliseconds = 1; milliseconds <= 20; ++milliseconds) {
    SCOPED_TRACE(milliseconds);
    const double period = 0.001 * milliseconds;
    KinematicCar loop(car, ReferencePoint::kRearAxle, Start());
    while (loop.state().distance + kSpeed * period <= distance) {
      loop.Step({.steering = schedule.At(loop.state().distance + kSpeed * period)}, period);
    }
    loop.Step({}, (distance - loop.state().distance) / kSpeed);
    const double heading =
        2.0 * kSpeed * car.steering_rate * period * period / (4.0 * car.wheelbase);
    EXPECT_NEAR(loop.state().pose.yaw, exact.pose.yaw, Tolerance(heading + 1e-10));
    EXPECT_NEAR((loop.state().pose.position() - exact.pose.position()).norm(), 0.0,
                Tolerance(heading * distance + 1e-9));
  }
}

}  // namespace steering_schedule_test
}  // namespace trackbed
