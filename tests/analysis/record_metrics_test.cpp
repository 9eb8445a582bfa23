// Tests the comparison of runs with recordings: on artificial recordings, on Trackbed's own logs
// and on imported logs of real vehicles.

#include "trackbed/analysis/record_metrics.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/metric_registry.h"
#include "trackbed/analysis/run.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/control/playback.h"
#include "trackbed/core/angle.h"
#include "trackbed/recording/import_log.h"
#include "trackbed/scenario/record.h"
#include "trackbed/scenario/record_scenario.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;

const fs::path kSource = TRACKBED_SOURCE_DIR;
const fs::path kMaps = kSource / "scenarios/real/maps";
const fs::path kLogs = kSource / "tests/data/recordings";
const std::string kSmallCar = (kSource / "tests/data/models/small_car.xml").string();

double Number(const PlantMetrics& metrics, const std::string& path) {
  for (const Metric& metric : ListMetrics(metrics)) {
    if (metric.path == path) {
      return std::get<double>(metric.value);
    }
  }
  ADD_FAILURE() << "no metric " << path;
  return 0.0;
}

/// A recording straight ahead at 2 m/s for 10 s, with a yaw rate and a lateral acceleration that do
/// not match this motion.
RecordedDrive Straight() {
  RecordedDrive drive{.name = "straight", .period = 0.1};
  for (int i = 0; i <= 100; ++i) {
    drive.samples.push_back({.time = 0.1 * i,
                             .pose = {0.2 * i, 0.0, 0.0},
                             .velocity_V = {2.0, 0.0},
                             .yaw_rate = 2.0,
                             .acceleration_V = {0.0, 4.0}});
  }
  return drive;
}

/// A run that diverges from the recording to the left by 0.01 m per second.
RunLog Beside(const RecordedDrive& drive) {
  RunLog log{.plant = "kinematic", .configurations = Table({"t_s"})};
  for (const RecordedSample& sample : drive.samples) {
    LogRow row;
    row.state.time = sample.time;
    row.state.pose = {sample.pose.x, 0.01 * sample.time, 0.03};
    row.state.distance = sample.pose.x;
    row.state.yaw_rate = 1.5;
    row.state.lateral_acceleration = 5.0;
    log.rows.push_back(row);
  }
  return log;
}

TEST(MeasureAgainstRecord, ComparesAtEqualTime) {
  RecordedDrive drive = Straight();
  const RunLog log = Beside(drive);
  const auto metrics = MeasureAgainstRecord(log, drive, {.cg_to_rear = 0.0}, 0.3);
  ASSERT_TRUE(metrics);
  // The metrics are exact except for rounding.
  EXPECT_NEAR(metrics->yaw_rate_relative_rms, 0.25, Tolerance(1e-12));
  EXPECT_NEAR(metrics->lateral_acceleration_relative_rms, 0.25, Tolerance(1e-12));
  EXPECT_NEAR(metrics->position_max, 0.1, Tolerance(1e-12));
  EXPECT_NEAR(metrics->position_max_t, 10.0, Tolerance(1e-12));
  EXPECT_NEAR(metrics->position_max_s, 20.0, Tolerance(1e-12));
  EXPECT_NEAR(metrics->position_final, 0.1, Tolerance(1e-12));
  // The mean of i^2 for i from 0 to 100 is 100 201/6.
  EXPECT_NEAR(metrics->position_rms, 0.001 * std::sqrt(100.0 * 201.0 / 6.0), Tolerance(1e-12));
  EXPECT_NEAR(metrics->heading_rms, 0.03, Tolerance(1e-12));
}

TEST(MeasureAgainstRecord, LeavesOutGapsAndSlowMoments) {
  RecordedDrive drive = Straight();
  const RunLog log = Beside(drive);
  for (std::size_t i = 50; i <= 100; ++i) {
    drive.samples[i].valid = false;
  }
  auto metrics = MeasureAgainstRecord(log, drive, {}, 0.3);
  EXPECT_NEAR(metrics->position_max_t, 4.9, Tolerance(1e-12));
  for (std::size_t i = 0; i < 50; ++i) {
    drive.samples[i].yaw_rate = 3.0;
    drive.samples[i].velocity_V.x() = i < 25 ? 0.1 : 1.0;
    drive.samples[i].yaw_rate = i < 25 ? 100.0 : 3.0;
  }
  metrics = MeasureAgainstRecord(log, drive, {}, 0.3);
  EXPECT_NEAR(metrics->yaw_rate_relative_rms, 0.5, Tolerance(1e-12));
  for (RecordedSample& sample : drive.samples) {
    sample.valid = false;
  }
  EXPECT_FALSE(MeasureAgainstRecord(log, drive, {}, 0.3));
}

/// Runs the small car on these plants for 6 s of weaving and writes the run folder.
RunResult Weave(const fs::path& folder) {
  const Scenario scenario = ParseScenario(
      fmt::format("schema: 1\nname: weave\nvehicle: {{model: {}}}\n"
                  "mission: {{speed: 1.5, duration: 6}}\n"
                  "control: {{method: sine, amplitude: 0.2, frequency: 0.4, cycles: 10}}\n"
                  "drive: {{plants: [kinematic, mujoco]}}\n",
                  kSmallCar),
      "weave.yaml", "/");
  RunResult result = RunScenario(scenario);
  WriteRunFolder(result, OutputFolder(folder));
  return result;
}

TEST(RecordedRuns, GiveTheStatesOfATrackbedLogAgain) {
  const TempFolder folder;
  const RunResult original = Weave(folder.path() / "weave");
  const LogMap map = ReadLogMap(kMaps / "trackbed.yaml");
  for (const RunLog& log : original.logs) {
    auto drive = std::make_shared<const RecordedDrive>(
        ImportLog(folder.path() / "weave" / run_folder::LogCsv(log.plant), map));
    const RunResult again = RunScenario(RecordScenario(drive, kSmallCar));
    ASSERT_EQ(again.logs.size(), 1U);
    const RunLog& recorded = again.logs.front();
    EXPECT_EQ(recorded.plant, "recorded");
    ASSERT_EQ(recorded.rows.size(), log.rows.size());
    // Parabolas through three rows reproduce the rows except for the rounding of numbers up to 10.
    // Slopes and curvatures are central differences over 20 ms; the one-sided differences at the
    // ends are less accurate.
    for (std::size_t i = 2; i + 2 < log.rows.size(); ++i) {
      const VehicleState& a = log.rows[i].state;
      const VehicleState& b = recorded.rows[i].state;
      EXPECT_NEAR(a.time, b.time, Tolerance(1e-9));
      EXPECT_NEAR(a.pose.x, b.pose.x, Tolerance(1e-11));
      EXPECT_NEAR(a.pose.y, b.pose.y, Tolerance(1e-11));
      EXPECT_NEAR(a.pose.yaw, b.pose.yaw, Tolerance(1e-11));
      EXPECT_NEAR(a.speed, b.speed, Tolerance(1e-11));
      EXPECT_NEAR(a.yaw_rate, b.yaw_rate, Tolerance(1e-11));
      EXPECT_NEAR(a.steering, b.steering, Tolerance(1e-11));
      // A central difference deviates by p''' dt^2/6; laterally, p''' = v r' = 1.5 m/s 1.2 rad/s
      // 2.5/s. MuJoCo integrates positions with the speed at the end of each step, so positions
      // reflect the speed half a step later: v r 0.001 s more.
      EXPECT_NEAR(a.lateral_speed, b.lateral_speed,
                  Tolerance(4.5 * 0.02 * 0.02 / 6.0 + 1.5 * 1.2 * 0.001));
    }
    EXPECT_NEAR(recorded.rows.back().state.distance, log.rows.back().state.distance,
                Tolerance(1e-3));  // trapezoids of 20 ms
  }
}

TEST(RecordedRuns, AreReplayedExactlyByThePlantThatTheyAreOf) {
  const TempFolder folder;
  const RunResult original = Weave(folder.path() / "weave");
  auto drive = std::make_shared<const RecordedDrive>(
      ImportLog(folder.path() / "weave/kinematic.csv", ReadLogMap(kMaps / "trackbed.yaml")));
  Scenario scenario = RecordScenario(drive, kSmallCar);
  scenario.drive.plants = {"recorded", "kinematic", "single_track"};
  scenario.record->steering = ReplaySteering::kMeasured;
  scenario.control.steering = PlaybackOptions{
      .recording = ReplayInputs(*drive, ReplaySteering::kMeasured, ReplayDrive::kSpeed)};
  scenario.expect.plants.emplace_back("kinematic", PlantExpectation{});
  scenario.expect.plants.back().second.metrics = {
      {.metric = "windows[1].position.p90", .max = 0.01},
      {.metric = "recorded.yaw_rate.relative_rms", .max = 0.01}};
  scenario.expect.between = {
      {.plants = {"recorded", "kinematic"}, .bounds = {.position_max = 0.01}}};
  const RunResult result = RunScenario(scenario);
  EXPECT_TRUE(result.verdict.passed) << testing::PrintToString(result.verdict.failures);
  // The angle measured at the end of a period is the command of the actuator at the beginning of
  // the period. The actuator turns at its full rate and then waits, so it reaches the angle up to a
  // period early. The steering angle errs by at most 0.5 rad/s x 20 ms = 0.01 rad, and by 0.005 rad
  // on average. The amplitude of the steering is 0.2 rad.
  EXPECT_LT(Number(result.metrics[1], "recorded.yaw_rate.relative_rms"), Tolerance(0.05));
  EXPECT_GT(Number(result.metrics[2], "recorded.yaw_rate.relative_rms"),
            2.0 * Number(result.metrics[1], "recorded.yaw_rate.relative_rms"));
  EXPECT_FALSE(result.metrics[0].recorded);
  EXPECT_TRUE(result.metrics[0].windows.empty());
  ASSERT_EQ(result.metrics[1].windows.size(), 3U);
  EXPECT_EQ(result.metrics[1].windows[0].count, 6);
  EXPECT_EQ(result.metrics[1].windows[2].count, 1);
  const auto json = MetricsJson(result);
  EXPECT_EQ(json["plants"]["kinematic"]["windows"][1]["horizon"], 2.0);
  EXPECT_TRUE(json["plants"]["kinematic"]["recorded"]["position"].contains("max_t"));
  EXPECT_FALSE(json["plants"]["recorded"].contains("windows"));
  EXPECT_THAT(result.verdict.notes, Contains(HasSubstr("record: ")));
}

TEST(RecordedRuns, AreWrittenAndComparedAsRuns) {
  const TempFolder folder;
  auto drive = std::make_shared<const RecordedDrive>(
      ImportLog(kLogs / "autoware.csv", ReadLogMap(kMaps / "autoware.yaml")));
  const RunResult result = RunScenario(RecordScenario(drive, kSmallCar));
  WriteRunFolder(result, OutputFolder(folder.path() / "run"));
  EXPECT_THAT(
      folder.path() / "run",
      testing::ResultOf([](const fs::path& run) { return fs::exists(run / "record.csv"); }, true));
  const auto drives = ReadRunFolder(folder.path() / "run");
  ASSERT_EQ(drives.size(), 1U);
  EXPECT_EQ(drives[0].trace.name, "recorded");
  EXPECT_EQ(drives[0].status, "arrived");
  const PlantComparison same = CompareTraces(MakeTrace(result.logs[0]), drives[0].trace);
  EXPECT_EQ(same.position.max, 0.0);
  // The resolved scenario in the run folder replays the same recording.
  const Scenario again = ReadScenario(folder.path() / "run" / run_folder::kScenarioYaml,
                                      {"drive.plants=[recorded, kinematic]"});
  EXPECT_EQ(again.record->data->samples.size(), drive->samples.size());
}

TEST(ImportedLogs, HaveTheMotionThatTheyWereMadeOf) {
  constexpr double kWheelbase = 0.33;
  const auto speed = [](double t) { return 2.0 + 0.5 * std::sin(0.6 * t); };
  const auto steering = [](double t) { return 0.25 * std::sin(0.9 * t) * std::cos(0.23 * t); };
  struct Case {
    const char* log;
    const char* map;
    double trim;
    double speed_error;
    double rate_error;
  };
  // The numbers in autoware.csv are rounded to 1e-6, and derivatives are fitted over 0.1 s. Fitting
  // a parabola causes an error of the yaw rate of psi''' h^2/6 with psi''' = 1.5 * 1.2^2 rad/s^3.
  // The f1tenth log has a position noise of 3 mm, which causes a standard deviation of 0.03 m/s in
  // the speed. The heading noise of the f1tenth log causes a standard deviation of 0.004 rad/s in
  // the yaw rate. The tolerances for f1tenth are at least four standard deviations.
  for (const Case& own : {Case{"autoware.csv", "autoware", 0.0, 1e-3, 0.01},
                          Case{"f1tenth/pfPoseData.csv", "f1tenth", 0.3, 0.15, 0.03}}) {
    const RecordedDrive drive =
        ImportLog(kLogs / own.log, ReadLogMap(kMaps / (std::string(own.map) + ".yaml")));
    EXPECT_NEAR(drive.duration(), 20.0 - 2.0 * own.trim, Tolerance(0.1)) << own.log;
    for (const RecordedSample& sample : drive.samples) {
      const double t = sample.time + own.trim;
      EXPECT_NEAR(sample.velocity_V.x(), speed(t), Tolerance(own.speed_error)) << own.log << t;
      EXPECT_NEAR(sample.yaw_rate, speed(t) * std::tan(steering(t)) / kWheelbase,
                  Tolerance(own.rate_error))
          << own.log << t;
      // Linear interpolation between rows 50 ms apart deviates by delta'' dt^2/8 = 0.3 0.0025/8.
      EXPECT_NEAR(sample.steering_command, steering(t), Tolerance(2e-4)) << own.log << t;
    }
  }
}

TEST(ImportedLogs, HaveTheDartCarsMotion) {
  const LogMap map = ReadLogMap(kMaps / "dart.yaml");
  struct Case {
    const char* log;
    double shortest;  // [s]
    double fastest;   // [m/s]
  };
  for (const Case& own : {Case{"free_driving_a", 80.0, 2.4}, Case{"free_driving_b", 40.0, 2.9},
                          Case{"ramp_steer_02", 60.0, 1.0}, Case{"ramp_steer_neg03", 60.0, 1.0},
                          Case{"steering_identification", 20.0, 0.5}}) {
    const RecordedDrive drive =
        ImportLog(kSource / "tests/data/dart" / (std::string(own.log) + ".csv"), map);
    EXPECT_GT(drive.duration(), own.shortest) << own.log;
    EXPECT_GT(drive.valid_fraction(), 0.95) << own.log;
    const auto fastest = std::max_element(
        drive.samples.begin(), drive.samples.end(),
        [](const auto& a, const auto& b) { return a.velocity_V.x() < b.velocity_V.x(); });
    EXPECT_GT(fastest->velocity_V.x(), own.fastest) << own.log;
    EXPECT_LT(fastest->velocity_V.x(), 4.0) << own.log;
    // The rear axle of a gently driven car hardly moves sideways, so a small lateral speed shows
    // that the lever arm and the misalignment are right. According to the tyre fit of the authors
    // of the data, the slip angle of the rear axle is 0.03 rad at 1.5 m/s^2.
    double sideways = 0.0;
    double count = 0.0;
    for (const RecordedSample& sample : drive.samples) {
      if (sample.velocity_V.x() > 0.5 && std::abs(sample.acceleration_V.y()) < 1.5) {
        sideways += sample.velocity_V.y() / sample.velocity_V.x();
        count += 1.0;
      }
    }
    EXPECT_LT(std::abs(sideways / std::max(count, 1.0)), 0.03) << own.log;
  }
}

}  // namespace
}  // namespace trackbed
