#include "trackbed/vehicle/steering_response.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {
namespace {

constexpr double kTimestep = 0.002;

std::vector<double> Filtered(const SteeringResponse& response, const std::vector<double>& commands,
                             double start = 0.0) {
  SteeringFilter filter(response, kTimestep, start);
  std::vector<double> angles;
  for (const double command : commands) {
    angles.push_back(filter.Pass(command));
  }
  return angles;
}

std::vector<double> RandomCommands(std::size_t count) {
  Random random(23);
  std::vector<double> commands;
  for (std::size_t i = 0; i < count; ++i) {
    commands.push_back(random.Uniform(-0.4, 0.4));
  }
  return commands;
}

/// Steering curve of a servo that turns further to the right than to the left.
std::vector<Vec2> Asymmetric() {
  std::vector<Vec2> points;
  for (int i = -4; i <= 4; ++i) {
    const double command = 0.1 * i;
    points.emplace_back(command, (command > 0.0 ? 0.36 : 0.51) * std::tanh(command / 0.36));
  }
  return points;
}

TEST(MonotoneCurve, IsExactAtItsPointsAndHeldBeyond) {
  const std::vector<Vec2> points = Asymmetric();
  const MonotoneCurve curve(points);
  for (const Vec2& point : points) {
    // Rounding of a cubic whose values are below 1 at its ends.
    EXPECT_NEAR(curve.At(point.x()), point.y(), Tolerance(1e-15));
  }
  EXPECT_EQ(curve.At(7.0), curve.At(0.4));
  EXPECT_EQ(curve.At(-7.0), curve.At(-0.4));
}

TEST(MonotoneCurve, IsALineBetweenPointsOfOne) {
  const MonotoneCurve curve({{-1.0, -2.0}, {0.0, 0.0}, {0.5, 1.0}, {3.0, 6.0}});
  for (double x = -1.0; x <= 3.0; x += 0.01) {
    EXPECT_NEAR(curve.At(x), 2.0 * x, Tolerance(1e-14));  // rounding
  }
}

TEST(MonotoneCurve, NeverTurnsBack) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Vec2> points{{0.0, 0.0}};
    for (int i = 0; i < 6; ++i) {
      // The slopes vary from 0.01 to 100 between neighboring points, so a natural spline would
      // overshoot.
      points.emplace_back(points.back() + Vec2(random.Uniform(0.05, 1.0),
                                               std::pow(10.0, random.Uniform(-2.0, 2.0))));
    }
    const MonotoneCurve curve(points);
    double before = curve.At(0.0);
    for (double x = 0.0; x <= points.back().x(); x += 0.01) {
      EXPECT_GE(curve.At(x), before - 1e-12) << trial << " " << x;  // rounding of values to 600
      before = curve.At(x);
    }
  }
}

TEST(MonotoneCurve, RefusesPointsOutOfOrder) {
  EXPECT_THROW(MonotoneCurve({{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}}), PreconditionError);
  EXPECT_THROW(MonotoneCurve({{0.0, 0.0}, {1.0, 1.0}, {1.0, 2.0}, {2.0, 3.0}}), PreconditionError);
  EXPECT_THROW(MonotoneCurve({{0.0, 0.0}, {1.0, 1.0}, {2.0, 0.5}, {3.0, 3.0}}), PreconditionError);
  EXPECT_THROW(MonotoneCurve({{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}, {3.0, std::nan("")}}),
               PreconditionError);
  EXPECT_THROW(static_cast<void>(MonotoneCurve(Asymmetric()).At(std::nan(""))), PreconditionError);
}

TEST(SteeringFilter, PassesWhatArrivesDuringATimestepForItsShare) {
  // A step of 1 rad with a dead time of 2.3 timesteps arrives after 0.3 of the third timestep.
  SteeringFilter filter({.dead_time = 2.3 * kTimestep}, kTimestep, 0.0);
  std::vector<double> passed;
  for (int i = 0; i < 5; ++i) {
    passed.push_back(filter.Pass(1.0));
  }
  EXPECT_THAT(passed, testing::ElementsAre(0.0, 0.0, testing::DoubleNear(0.7, 1e-12),
                                           testing::DoubleNear(1.0, 1e-12), 1.0));
}

TEST(RestingSteering, IsWhereTheWheelsComeToRestFromStraightAhead) {
  VehicleParams params{.steering_limit = 0.5};
  params.steering_response.backlash = 0.04;
  EXPECT_THAT(RestingSteering(params, 0.2), testing::DoubleNear(0.18, 1e-15));
  EXPECT_THAT(RestingSteering(params, -0.2), testing::DoubleNear(-0.18, 1e-15));
  EXPECT_EQ(RestingSteering(params, 0.01), 0.0);  // within the play
  EXPECT_EQ(RestingSteering(params, 1.0), 0.5);   // the limit
}

TEST(SteeringFilter, IdealGivesTheCommand) {
  const std::vector<double> commands = RandomCommands(200);
  EXPECT_TRUE(SteeringResponse{}.ideal());
  EXPECT_EQ(Filtered({}, commands), commands);
}

TEST(SteeringFilter, LagsByItsTimeConstant) {
  // The response to a unit step is 1 - exp(-t/tau) at the end of each timestep.
  const std::vector<double> angles =
      Filtered({.time_constant = 0.1}, std::vector<double>(500, 1.0));
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double t = kTimestep * static_cast<double>(i + 1);
    EXPECT_NEAR(angles[i], 1.0 - std::exp(-t / 0.1), Tolerance(1e-13));  // 500 rounded products
  }
}

TEST(SteeringFilter, IsBehindARampByItsDelay) {
  constexpr double kRate = 0.5;
  const SteeringResponse response{.dead_time = 0.05, .time_constant = 0.08};
  std::vector<double> ramp;
  for (int i = 0; i < 1000; ++i) {
    ramp.push_back(kRate * kTimestep * i);
  }
  // A ramp that is held over each timestep is late by half a timestep on average. The output of the
  // filter is the angle at the end of the timestep. After 1.87 s, a fraction of exp(-1.87/0.08) of
  // the initial transient remains.
  const double held = kTimestep / 2.0;
  const double expected = ramp.back() + kRate * (kTimestep - held - response.delay());
  // The lag of a held ramp differs from the exact one by T^2/(12 tau).
  EXPECT_NEAR(Filtered(response, ramp).back(), expected,
              Tolerance(kRate * kTimestep * kTimestep / (12.0 * 0.08) * 1.01));
}

TEST(SteeringFilter, TurnsAsItsCurveSays) {
  const MonotoneCurve curve(Asymmetric());
  const std::vector<double> commands = RandomCommands(200);
  const std::vector<double> angles = Filtered({.curve = Asymmetric()}, commands);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    EXPECT_EQ(angles[i], curve.At(commands[i]));
  }
}

TEST(SteeringFilter, LosesItsBacklashAtEveryTurn) {
  std::vector<double> commands;
  for (int i = 0; i <= 400; ++i) {
    commands.push_back(0.001 * (i <= 100 ? i : i <= 300 ? 200 - i : i - 400));
  }
  const std::vector<double> angles = Filtered({.backlash = 0.02}, commands);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    // While the command rises, the angle is behind it by half of the play. After a reversal, the
    // angle rests until the command has moved by the play, and then is behind by half of the play
    // again.
    const double up = std::max(0.0, commands[i] - 0.01);
    const double down = std::min(0.09, commands[i] + 0.01);
    const double again = std::max(-0.09, commands[i] - 0.01);
    EXPECT_NEAR(angles[i], i <= 100 ? up : i <= 300 ? down : again, Tolerance(1e-15)) << i;
  }
}

TEST(SteeringFilter, StartsAtRestWhereItStands) {
  // The filter starts at the given angle without inverting the curve, because the curve need not
  // reach that angle.
  const SteeringResponse response{.dead_time = 0.01, .time_constant = 0.1, .backlash = 0.04};
  const std::vector<double> angles = Filtered(response, std::vector<double>(5, 0.3), 0.2);
  EXPECT_EQ(angles, std::vector<double>(5, 0.2));  // 10 ms are five timesteps
}

TEST(SteeringFilter, RefusesNumbersOutOfRange) {
  EXPECT_THROW(SteeringFilter({.dead_time = -1.0}, kTimestep, 0.0), PreconditionError);
  EXPECT_THROW(SteeringFilter({.dead_time = 1e9}, kTimestep, 0.0), PreconditionError);
  EXPECT_THROW(SteeringFilter({.time_constant = std::nan("")}, kTimestep, 0.0), PreconditionError);
  EXPECT_THROW(SteeringFilter({.backlash = -0.1}, kTimestep, 0.0), PreconditionError);
  SteeringFilter filter({.time_constant = 0.1}, kTimestep, 0.0);
  EXPECT_THROW(filter.Pass(std::nan("")), PreconditionError);
}

}  // namespace
}  // namespace trackbed
