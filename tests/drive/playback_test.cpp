#include "trackbed/control/playback.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/geometry/random.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/control/recording_file.h"
#include "trackbed/core/file.h"
#include "trackbed/drive/drive.h"

// Tests runs that replay recordings.
namespace trackbed {
namespace {

constexpr double kPriusRate = 0.15056818181818182;  // rate limit of the steering actuator [rad/s]

/// A recording of 6 s with unevenly spaced rows. Steering and speed vary randomly, at up to `rate`
/// [rad/s] and 8 m/s^2.
Recording Wandering(std::uint64_t seed, double rate) {
  Random random(seed);
  Recording recording{{}, {}, {}};
  double steering = random.Uniform(-0.1, 0.1);
  double speed = 12.0;
  for (double t = 0.0; t < 6.0;) {
    recording.steering.knots.emplace_back(t, steering);
    recording.speed.knots.emplace_back(t, speed);
    const double step = random.Uniform(0.005, 0.05);
    steering = std::clamp(steering + random.Uniform(-rate, rate) * step, -0.3, 0.3);
    speed = std::clamp(speed + random.Uniform(-8.0, 8.0) * step, 1.0, 30.0);
    t += step;
  }
  return recording;
}

Scenario Replay(const Recording& recording, const std::string& plant, SteeringInput steering) {
  Scenario scenario;
  scenario.name = "replay";
  scenario.control.steering =
      PlaybackOptions{.file = {}, .by = PlaybackAxis::kTime, .columns = {}, .recording = recording};
  scenario.drive.plants = {plant};
  scenario.drive.steering = steering;
  return scenario;
}

RunLog Drive(const Scenario& scenario) {
  CheckScenario(scenario);
  const CarModel car = LoadCar(scenario);
  return SimulateScenario(scenario, car, PlanScenario(scenario, car.params()),
                          scenario.drive.plants.front());
}

TEST(Playback, OnPrescribedWheelsGivesTheRecordedAngleAndSpeed) {
  for (const std::uint64_t seed : {91U, 92U, 93U}) {
    const Recording recording = Wandering(seed, 2.0);
    const RunLog log = Drive(Replay(recording, "kinematic", SteeringInput::kPrescribed));
    EXPECT_EQ(log.status, DriveStatus::kArrived);
    EXPECT_NEAR(log.rows.back().state.time, recording.steering.knots.back().x(), 0.02);
    ASSERT_GE(log.rows.size(), 298U);
    for (const LogRow& row : log.rows) {
      const VehicleState& state = row.state;
      EXPECT_NEAR(state.steering, recording.steering.At(state.time), Tolerance(1e-12));
      // Each period adds a rounding error of a few 1e-15 m/s to the speed, and the gain removes 4 %
      // of the speed error.
      EXPECT_NEAR(state.speed, recording.speed.At(state.time), Tolerance(1e-12));
    }
  }
}

TEST(Playback, ThroughTheActuatorKeepsItsRate) {
  for (const std::uint64_t seed : {91U, 92U, 93U}) {
    const Recording recording = Wandering(seed, 2.0);
    const RunLog log = Drive(Replay(recording, "kinematic", SteeringInput::kActuator));
    double behind = 0.0;
    for (std::size_t i = 1; i < log.rows.size(); ++i) {
      const VehicleState& state = log.rows[i].state;
      EXPECT_LE(std::abs(state.steering - log.rows[i - 1].state.steering),
                0.02 * kPriusRate + Tolerance(1e-14));
      behind = std::max(behind, std::abs(state.steering - recording.steering.At(state.time)));
    }
    EXPECT_GT(behind, 0.01);  // the recording is faster than the actuator
  }
}

TEST(Playback, ThroughTheActuatorIsExactWhereTheRateAllows) {
  const Recording recording = Wandering(94, kPriusRate);
  Scenario scenario = Replay(recording, "kinematic", SteeringInput::kActuator);
  scenario.mission.start.steering = recording.steering.At(0.0);
  for (const LogRow& row : Drive(scenario).rows) {
    EXPECT_NEAR(row.state.steering, recording.steering.At(row.state.time), Tolerance(1e-12));
  }
}

TEST(Playback, BrakesAsHardAsWasRecordedOnMujocoToo) {
  // The recording brakes from 20 m/s at 6 m/s^2 for 2 s. Tyres with a friction coefficient of 0.9
  // allow 8.8 m/s^2.
  const Recording recording{
      {{{0.0, 0.0}}}, {{{0.0, 20.0}, {1.0, 20.0}, {3.0, 8.0}, {4.0, 8.0}}}, {}};
  Scenario scenario = Replay(recording, "mujoco", SteeringInput::kActuator);
  scenario.mission.duration = 4.0;
  const RunLog log = Drive(scenario);
  ASSERT_EQ(log.rows.size(), 201U);
  for (const LogRow& row : log.rows) {
    // The deceleration of the brakes errs by 5 % of 6 m/s^2, which causes a speed error of 0.15 m/s
    // with the gain of 2 1/s. The braking car pitches by 2 degrees, which changes the speed by at
    // most 0.02 m/s at a height of 0.5 m.
    EXPECT_NEAR(row.state.speed, recording.speed.At(row.state.time), Tolerance(0.17));
  }
}

TEST(Playback, ByDistanceTurnsTheWheelsWhereTheyWereTurned) {
  Scenario scenario = Replay(Wandering(95, 2.0), "kinematic", SteeringInput::kPrescribed);
  auto& playback = scenario.control.steering.Get<PlaybackOptions>();
  playback.by = PlaybackAxis::kDistance;
  playback.recording.speed = {{{0.0, 0.3}}};  // the car moves 6 mm per period, so 6 m take 20 s
  scenario.mission.duration = 20.0;
  const RunLog log = Drive(scenario);
  EXPECT_NEAR(log.rows.back().state.distance, 6.0, Tolerance(1e-11));
  for (const LogRow& row : log.rows) {
    // The distance is a sum over a thousand periods of 6 mm, with a rounding error of 1e-15 m each.
    // The recorded steering angle changes by up to 2 rad/m.
    EXPECT_NEAR(row.state.steering, playback.recording.steering.At(row.state.distance),
                Tolerance(1e-11));
  }
}

TEST(Playback, WithoutASpeedHoldsTheMissions) {
  Scenario scenario =
      Replay({{{{0.0, 0.0}, {3.0, 0.1}}}, {}, {}}, "kinematic", SteeringInput::kActuator);
  EXPECT_THROW(CheckScenario(scenario), InputError);  // no speed is given
  scenario.mission.speed = 7.0;
  for (const LogRow& row : Drive(scenario).rows) {
    EXPECT_EQ(row.state.speed, 7.0);
  }
}

TEST(Playback, OfItsOwnLogIsTheSameDrive) {
  // Drives along a path, then replays the logged commands in a run without a path.
  const Scenario first = ReadScenario(std::string(TRACKBED_SOURCE_DIR) + "/scenarios/winding.yaml",
                                      {"drive.plants=[kinematic]", "expect={}"});
  const RunLog log = Drive(first);
  const TempFolder folder;
  WriteFileAtomically(folder.path() / "log.csv", ToTable(log).ToCsv());
  const Scenario again = ParseScenario(
      fmt::format("schema: 1\nname: again\nmission: {{start: {{x: {}, y: {}, yaw: {}}}}}\n"
                  "control: {{method: playback, file: log.csv}}\ndrive: {{plants: [kinematic]}}\n",
                  log.rows[0].state.pose.x, log.rows[0].state.pose.y, log.rows[0].state.pose.yaw),
      "again.yaml", folder.path());
  const RunLog replayed = Drive(again);
  ASSERT_EQ(replayed.rows.size(), log.rows.size());
  double untold = 0.0;
  for (std::size_t i = 0; i < log.rows.size(); ++i) {
    const VehicleState& a = log.rows[i].state;
    const VehicleState& b = replayed.rows[i].state;
    const double before = i > 0 ? log.rows[i - 1].state.speed : 0.0;
    if (a.speed == 0.0 && before > 0.0) {
      // The log does not record at which time within the period the car came to rest. The replay
      // brings the car to rest at the end of the period.
      untold += 0.5 * before * 0.02;
      EXPECT_LT(untold, 1e-3);
    }
    // The same actuator reaches the same angles by the same operations. The speeds differ by
    // rounding, and so do the poses after 60 s.
    EXPECT_NEAR(b.steering, a.steering, Tolerance(1e-12));
    EXPECT_NEAR((b.pose.position() - a.pose.position()).norm(), 0.0, Tolerance(1e-9 + untold));
  }
}

}  // namespace
}  // namespace trackbed
