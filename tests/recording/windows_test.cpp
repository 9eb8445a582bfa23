#include "trackbed/recording/windows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/control/playback.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/sim/plant.h"
#include "trackbed/sim/scene.h"

namespace trackbed {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kPeriod = 0.02;  // [s]

CarModel SmallCar(const std::string& steering_response = "") {
  const TempFolder folder;
  std::string xml =
      ReadFile(std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/models/small_car.xml");
  const std::string begin = "<custom>";
  xml.insert(xml.find(begin) + begin.size(), steering_response);
  return {ComposeScene(folder.Write("car.xml", xml), {}), "small_car"};
}

CarModel LateCar() {
  return SmallCar(
      R"(<numeric name="steering_dead_time" data="0.044"/>)"
      R"(<numeric name="steering_time_constant" data="0.06"/>)"
      R"(<numeric name="steering_backlash" data="0.01"/>)"
      R"(<numeric name="steering_curve" data="-0.4 -0.3  -0.1 -0.1  0.1 0.05  0.4 0.35"/>)");
}

/// Accelerates from 1 m/s at 0.2 m/s^2 and weaves below the car's steering rate.
Recording Inputs(double duration) {
  Recording inputs{.steering = {}, .speed = {}, .acceleration = {}};
  for (int i = 0; i * kPeriod < duration + kPeriod; ++i) {
    const double t = i * kPeriod;
    inputs.steering.knots.emplace_back(t, 0.2 * std::sin(1.5 * t));
    inputs.speed.knots.emplace_back(t, 1.0 + 0.2 * t);
  }
  return inputs;
}

/// A recording of a plant's response to these inputs.
RecordedDrive Drive(const CarModel& car, const std::string& name, double duration) {
  const PlaybackOptions playback{.recording = Inputs(duration)};
  const World world;
  const double start = RestingSteering(car.params(), playback.recording.steering.At(0.0));
  const auto plant =
      MakePlant(name, {.car = car, .world = world, .start = {.speed = 1.0, .steering = start}});
  RecordedDrive drive{.name = name, .period = kPeriod, .has_steering_command = true};
  const double l = car.params().cg_to_rear;
  for (int i = 0; i * kPeriod <= duration; ++i) {
    const double t = i * kPeriod;
    const VehicleState state = plant->Observe();
    drive.samples.push_back({.time = t,
                             .pose = state.pose,
                             .velocity_V = {state.speed, state.lateral_speed - l * state.yaw_rate},
                             .yaw_rate = state.yaw_rate,
                             .steering_command = playback.recording.steering.At(t)});
    const Command command{
        .steering = PlaybackSteering(playback, t, state.speed, kPeriod),
        .acceleration = *PlaybackAcceleration(playback, t, state.speed, 20.0, kPeriod)};
    for (int k = 0; k < std::lround(kPeriod / car.timestep()); ++k) {
      plant->Step(command);
    }
  }
  return drive;
}

/// Returns the largest distance [m] between the record and any state in the windows.
double LargestDistance(const std::vector<WindowPrediction>& windows, const RecordedDrive& drive) {
  double largest = 0.0;
  for (const WindowPrediction& window : windows) {
    for (const VehicleState& state : window.states) {
      const Vec2 recorded = drive.At(state.time).pose.position();
      largest = std::max(largest, (state.pose.position() - recorded).norm());
    }
  }
  return largest;
}

TEST(PredictWindows, EachWindowIsThatPartOfTheWholeDrive) {
  const CarModel car = LateCar();
  for (const char* plant : {"kinematic", "single_track"}) {
    const RecordedDrive drive = Drive(car, plant, 6.0);
    const auto windows =
        PredictWindows(car, plant, drive, {0.0, 1.0, 2.5, 3.98}, 2.0, {.control_period = kPeriod});
    ASSERT_EQ(windows.size(), 4U) << plant;
    EXPECT_THAT(windows[2].start, DoubleNear(2.5, Tolerance(1e-12)));
    EXPECT_EQ(windows[2].states.size(), 101U);
    // The windows integrate the same equations from the same states as the record. The states
    // differ by rounding, 1e-16 per step over 1000 steps, and by 1e-12 because solver steps are
    // split at different times.
    EXPECT_LT(LargestDistance(windows, drive), Tolerance(1e-9)) << plant;
  }
}

TEST(PredictWindows, MujocoRestartsOnItsSprings) {
  const CarModel car = SmallCar();
  const RecordedDrive drive = Drive(car, "mujoco", 6.0);
  const auto windows =
      PredictWindows(car, "mujoco", drive, {1.0, 3.0}, 2.0, {.control_period = kPeriod});
  // In a bend with a curvature of 0.8 1/m at 1.6 m/s, the lateral force of the front tyres brakes
  // the car by a_y tan(delta)/2 = 2 m/s^2 * 0.1 = 0.2 m/s^2. With the gain of 20 1/s, the speed
  // error is 0.01 m/s, which is 0.02 m after 2 s. The roll motion after each restart adds less.
  EXPECT_LT(LargestDistance(windows, drive), Tolerance(0.02));
  EXPECT_GT(LargestDistance(windows, drive), 0.0);
}

TEST(PredictWindows, StartsWithTheRecordedSlip) {
  const CarModel car = SmallCar();
  const RecordedDrive drive = Drive(car, "single_track", 3.0);
  for (const char* plant : {"single_track", "mujoco"}) {
    const auto windows = PredictWindows(car, plant, drive, {1.0}, 0.1, {.control_period = kPeriod});
    const RecordedSample recorded = drive.At(1.0);
    const VehicleState& first = windows.front().states.front();
    // The tolerance covers rounding of the conversion to the free joint's velocity and back.
    EXPECT_THAT(first.yaw_rate, DoubleNear(recorded.yaw_rate, Tolerance(1e-12))) << plant;
    EXPECT_THAT(first.lateral_speed,
                DoubleNear(recorded.velocity_V.y() + car.params().cg_to_rear * recorded.yaw_rate,
                           Tolerance(1e-12)))
        << plant;
  }
}

TEST(StartFrom, TakesNoSlipFromTheNoiseOfASlowCar) {
  RecordedSample sample{.velocity_V = {0.5, 0.02}, .yaw_rate = 0.1};
  EXPECT_EQ(StartFrom(sample, 0.3).lateral_speed, 0.02);
  EXPECT_EQ(StartFrom(sample, 0.3).yaw_rate, 0.1);
  EXPECT_EQ(StartFrom(sample, 0.3).steering, 0.3);
  sample.velocity_V = {0.001, 0.001};
  EXPECT_FALSE(StartFrom(sample, 0.0).lateral_speed);
  EXPECT_FALSE(StartFrom(sample, 0.0).yaw_rate);
  sample.velocity_V.x() = -0.02;
  EXPECT_EQ(StartFrom(sample, 0.0).speed, 0.0);
}

TEST(PredictWindows, RefusesWhatItCannotDo) {
  const CarModel car = SmallCar();
  RecordedDrive drive = Drive(car, "kinematic", 2.0);
  EXPECT_THROW(PredictWindows(car, "kinematic", drive, {1.5}, 1.0, {.control_period = kPeriod}),
               PreconditionError);
  EXPECT_THROW(PredictWindows(car, "kinematic", drive, {0.0}, 1.0, {.control_period = 0.003}),
               PreconditionError);
  EXPECT_THROW(
      PredictWindows(car, "kinematic", drive, {0.0}, 1.0, {.steering = ReplaySteering::kMeasured}),
      InputError);
  EXPECT_THROW(
      PredictWindows(car, "kinematic", drive, {0.0}, 1.0, {.drive = ReplayDrive::kThrottle}),
      InputError);
  drive.samples[20].velocity_V.x() = -0.5;
  EXPECT_THROW(PredictWindows(car, "kinematic", drive, {0.0}, 1.0, {}), InputError);
}

TEST(PredictWindows, EndsEarlyWhenAsked) {
  const CarModel car = SmallCar();
  const RecordedDrive drive = Drive(car, "kinematic", 3.0);
  int asked = 0;
  const auto windows = PredictWindows(car, "kinematic", drive, {0.0, 0.5, 1.0}, 1.0,
                                      {.interrupted = [&] { return ++asked > 2; }});
  EXPECT_EQ(windows.size(), 2U);
}

/// A record straight ahead at 2 m/s for 10 s.
RecordedDrive Straight() {
  RecordedDrive drive{.name = "straight", .period = 0.1};
  for (int i = 0; i <= 100; ++i) {
    drive.samples.push_back(
        {.time = 0.1 * i, .pose = {0.2 * i, 0.0, 0.0}, .velocity_V = {2.0, 0.0}});
  }
  return drive;
}

TEST(WindowStarts, LeavesOutGapsAndStandstill) {
  RecordedDrive drive = Straight();
  EXPECT_THAT(WindowStarts(drive, 2.0, 3.0, 0.3), ElementsAre(0.0, 3.0, 6.0));
  drive.samples[45].valid = false;  // 4.5 s
  EXPECT_THAT(WindowStarts(drive, 2.0, 3.0, 0.3), ElementsAre(0.0, 6.0));
  EXPECT_THAT(WindowStarts(drive, 2.0, 3.0, 2.1), IsEmpty());
  EXPECT_THAT(WindowStarts(drive, 11.0, 3.0, 0.3), IsEmpty());
}

/// A window from `start` whose states are those of the record, shifted to the left and rotated.
WindowPrediction Beside(const RecordedDrive& drive, double start, double left, double yaw) {
  WindowPrediction window{.start = start};
  for (int i = 0; i <= 10; ++i) {
    const RecordedSample sample = drive.At(start + 0.1 * i);
    VehicleState state;
    state.time = sample.time;
    state.pose = {sample.pose.x, left, yaw};
    state.yaw_rate = 1.5;
    window.states.push_back(state);
  }
  return window;
}

TEST(MeasureWindows, GivesQuantilesOfWindowsAndRelativeErrors) {
  RecordedDrive drive = Straight();
  for (RecordedSample& sample : drive.samples) {
    sample.yaw_rate = 2.0;
  }
  const std::vector<WindowPrediction> windows{Beside(drive, 0.0, 0.1, 0.01),
                                              Beside(drive, 1.0, -0.3, -0.02),
                                              Beside(drive, 2.0, 0.2, 0.04)};
  const WindowErrors errors = MeasureWindows(windows, drive, {.cg_to_rear = 0.1}, 1.0, 0.3);
  EXPECT_EQ(errors.count, 3);
  EXPECT_EQ(errors.diverged, 0);
  // The sorted position errors are 0.1, 0.2 and 0.3 m, so the 90 % quantile is 0.8 of the way from
  // the second to the third. The tolerance covers rounding of positions of some meters.
  EXPECT_THAT(errors.position_median, DoubleNear(0.2, Tolerance(1e-12)));
  EXPECT_THAT(errors.position_p90, DoubleNear(0.28, Tolerance(1e-12)));
  EXPECT_THAT(errors.heading_median, DoubleNear(0.02, Tolerance(1e-12)));
  EXPECT_THAT(errors.heading_p90, DoubleNear(0.036, Tolerance(1e-12)));
  EXPECT_THAT(errors.yaw_rate_relative_rms, DoubleNear(0.25, Tolerance(1e-12)));
}

TEST(MeasureWindows, TakesADivergedWindowAsInfinitelyFar) {
  const RecordedDrive drive = Straight();
  std::vector<WindowPrediction> windows{Beside(drive, 0.0, 0.1, 0.0), Beside(drive, 1.0, 0.1, 0.0)};
  windows[1].diverged = true;
  windows[1].states.resize(3);
  const WindowErrors errors = MeasureWindows(windows, drive, {}, 1.0, 0.3);
  EXPECT_EQ(errors.diverged, 1);
  EXPECT_TRUE(std::isinf(errors.position_p90));
}

}  // namespace
}  // namespace trackbed
