#include "trackbed/control/playback.h"

#include <gtest/gtest.h>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/error.h"
#include "trackbed/vehicle/kinematic_car.h"

namespace trackbed {
namespace playback_test {

constexpr double kRounding = 1e-12;  // a few operations on numbers below 100

const Signal kSteering{{{0.0, 0.0}, {1.0, 0.1}, {2.0, -0.1}}};
const Signal kSpeed{{{0.0, 10.0}, {1.0, 12.0}, {3.0, 2.0}}};

PlaybackOptions Replay(PlaybackAxis by, const Recording& recording) {
  return {.file = {}, .by = by, .columns = {}, .recording = recording};
}

TEST(Playback, SteersToWhereThePeriodEnds) {
  const PlaybackOptions time = Replay(PlaybackAxis::kTime, {kSteering, {}, {}});
  EXPECT_NEAR(PlaybackSteering(time, 0.4, 7.0, 0.1), 0.05, Tolerance(kRounding));
  EXPECT_NEAR(PlaybackSteering(time, 0.95, 7.0, 0.1), 0.09, Tolerance(kRounding));
  EXPECT_EQ(PlaybackSteering(time, 2.5, 7.0, 0.1), -0.1);
  // At 5 m/s, forward or backward, the recording advances by 0.5 m during the period of 0.1 s.
  const PlaybackOptions distance = Replay(PlaybackAxis::kDistance, {kSteering, {}, {}});
  EXPECT_NEAR(PlaybackSteering(distance, 0.25, 5.0, 0.1), 0.075, Tolerance(kRounding));
  EXPECT_NEAR(PlaybackSteering(distance, 0.25, -5.0, 0.1), 0.075, Tolerance(kRounding));
  EXPECT_NEAR(PlaybackSteering(distance, 0.25, 0.0, 0.1), 0.025, Tolerance(kRounding));
}

TEST(Playback, WithoutSpeedOrAccelerationLeavesTheSpeedAlone) {
  const PlaybackOptions options = Replay(PlaybackAxis::kTime, {kSteering, {}, {}});
  EXPECT_EQ(PlaybackAcceleration(options, 0.5, 7.0, 2.0, 0.1), std::nullopt);
}

TEST(Playback, FollowsTheSpeedWithFeedForwardAndGain) {
  const PlaybackOptions time = Replay(PlaybackAxis::kTime, {kSteering, kSpeed, {}});
  EXPECT_NEAR(*PlaybackAcceleration(time, 0.5, 11.0, 2.0, 0.1), 2.0, Tolerance(kRounding));
  EXPECT_NEAR(*PlaybackAcceleration(time, 0.5, 10.5, 2.0, 0.1), 3.0, Tolerance(kRounding));
  // The period contains the knot at 1 s: the recorded speed rises by 0.1 m/s and then falls by 0.25
  // m/s.
  EXPECT_NEAR(*PlaybackAcceleration(time, 0.95, 11.9, 2.0, 0.1), -1.5, Tolerance(kRounding));
  // A recording over distance advances by 1 m in 0.1 s at 10 m/s.
  const PlaybackOptions distance = Replay(PlaybackAxis::kDistance, {kSteering, kSpeed, {}});
  EXPECT_NEAR(*PlaybackAcceleration(distance, 0.0, 10.0, 2.0, 0.1), 20.0, Tolerance(kRounding));
}

TEST(Playback, TakesTheMeanOfTheAcceleration) {
  const Signal acceleration{{{0.0, 0.0}, {1.0, 2.0}, {1.5, -8.0}}};
  const PlaybackOptions time = Replay(PlaybackAxis::kTime, {kSteering, {}, acceleration});
  EXPECT_NEAR(*PlaybackAcceleration(time, 0.5, 3.0, 2.0, 0.1), 1.1, Tolerance(kRounding));
  EXPECT_EQ(*PlaybackAcceleration(time, 1.5, 3.0, 2.0, 0.1), -8.0);
  const PlaybackOptions distance = Replay(PlaybackAxis::kDistance, {kSteering, {}, acceleration});
  EXPECT_NEAR(*PlaybackAcceleration(distance, 0.5, 3.0, 2.0, 0.1), 1.3, Tolerance(kRounding));
  // At rest, the acceleration is that at the car's station.
  EXPECT_NEAR(*PlaybackAcceleration(distance, 0.5, 0.0, 2.0, 0.1), 1.0, Tolerance(kRounding));
}

TEST(Playback, ByDistanceTheControllerAsksTheOdometer) {
  const VehicleParams car = ReferenceCar();
  const Reference reference;
  const SteeringSchedule schedule;
  VehicleState state;
  state.time = 1.9;
  state.distance = 0.25;
  state.speed = 5.0;
  const ControlInput input{.vehicle = car,
                           .reference = reference,
                           .schedule = schedule,
                           .state = state,
                           .station = 1.5,  // a station on another plan
                           .period = 0.1,
                           .speed_gain = 4.0};
  const auto by_distance =
      MakeSteeringController(Replay(PlaybackAxis::kDistance, {kSteering, {{{0.0, 6.0}}}, {}}));
  EXPECT_NEAR(by_distance->Steer(input), 0.075, Tolerance(kRounding));
  EXPECT_NEAR(*by_distance->Accelerate(input), 4.0, Tolerance(kRounding));
  const auto by_time = MakeSteeringController(Replay(PlaybackAxis::kTime, {kSteering, {}, {}}));
  EXPECT_NEAR(by_time->Steer(input), -0.1, Tolerance(kRounding));
  EXPECT_EQ(by_time->Accelerate(input), std::nullopt);
}

TEST(Playback, RefusesRecordingsThatAreNone) {
  const auto make = [](const Recording& recording) {
    return MakeSteeringController(Replay(PlaybackAxis::kTime, recording));
  };
  EXPECT_THROW(make({{}, {}, {}}), InternalError);
  EXPECT_THROW(make({{{{1.0, 0.0}, {1.0, 0.1}}}, {}, {}}), InternalError);
  EXPECT_THROW(make({kSteering, kSpeed, kSpeed}), InternalError);
}

TEST(Playback, OfAccelerationGivesItsIntegral) {
  // The mean acceleration times the period is the change of speed, so the speed is exact for any
  // period. The speed is 10 m/s + 2 t - t^2; the rows of the recording do not coincide with the
  // control periods.
  Signal acceleration;
  for (int i = 0; i <= 30; ++i) {
    acceleration.knots.emplace_back(i / 15.0, 2.0 - 2.0 * i / 15.0);
  }
  const PlaybackOptions options = Replay(PlaybackAxis::kTime, {kSteering, {}, acceleration});
  KinematicCar car(ReferenceCar(), ReferencePoint::kRearAxle, {.speed = 10.0});
  for (int i = 0; i < 100; ++i) {
    const double t = 0.02 * i;
    EXPECT_NEAR(car.state().speed, 10.0 + 2.0 * t - t * t, Tolerance(kRounding)) << t;
    car.Step({.acceleration = *PlaybackAcceleration(options, t, car.state().speed, 2.0, 0.02)},
             0.02);
  }
}

}  // namespace playback_test
}  // namespace trackbed
