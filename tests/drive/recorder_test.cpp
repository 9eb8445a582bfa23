#include "src/drive/recorder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "tests/drive/unicycle.h"
#include "tests/tolerance.h"

namespace trackbed {
namespace {

/// An obstacle of 1 m by 1 m whose near side is 10 m ahead of the origin.
Obstacle Box(const Vec2& velocity = Vec2::Zero()) {
  return {.footprint = {{10.5, 0.0, 0.0}, 1.0, 1.0}, .velocity = velocity};
}

/// The footprint begins at the rear axle, and its front is 4 m ahead of the rear axle.
LoopConfig Config() {
  LoopConfig config{.vehicle = UnicycleParams(), .state_period = 0.1};
  config.configuration_columns = {"x_m", "y_m"};
  return config;
}

TEST(Recorder, LogsTheExtremesSinceTheRowBefore) {
  LoopConfig config = Config();
  config.world.obstacles = {Box()};
  Unicycle plant({});
  Recorder recorder(config, {});
  recorder.Sample(plant, 0.0);
  EXPECT_NEAR(*recorder.BeginRow({}, {}, {}).clearance, 6.0, Tolerance(1e-9));
  // The car moves forward and back within one period. At x = 3 m, its front is at 7 m, 3 m from the
  // obstacle at 10 m.
  for (const auto& [x, force, time] : {std::tuple(3.0, 20.0, 0.01), std::tuple(1.0, 5.0, 0.02)}) {
    plant.state().pose.x = x;
    plant.force = 0.0;
    recorder.Sample(plant, time);
  }
  const LogRow row = recorder.BeginRow({}, {}, {});
  EXPECT_NEAR(*row.clearance, 3.0, Tolerance(1e-9));
  EXPECT_EQ(row.state.obstacle_force, 0.0);
  EXPECT_FALSE(recorder.contact_time());
  // No state was recorded since the last row, so the clearance is that of the current pose.
  EXPECT_NEAR(*recorder.BeginRow({}, {}, {}).clearance, 5.0, Tolerance(1e-9));
}

TEST(Recorder, LogsTheFirstContactAndTheLargestForce) {
  LoopConfig config = Config();
  config.world.obstacles = {Box()};
  Unicycle plant({});
  Recorder recorder(config, {});
  recorder.Sample(plant, 0.0);
  const double forces[] = {0.0, 40.0, 15.0};
  for (int i = 0; i < 3; ++i) {
    plant.force = forces[i];
    recorder.Sample(plant, 0.1 * (i + 1));
  }
  // A contact force of the plant counts as a contact, independent of the footprint.
  const LogRow row = recorder.BeginRow({}, {}, {});
  EXPECT_EQ(*row.clearance, 0.0);
  EXPECT_EQ(row.state.obstacle_force, 40.0);
  const RunLog log = recorder.Finish(DriveStatus::kCollided);
  EXPECT_EQ(log.status, DriveStatus::kCollided);
  EXPECT_EQ(log.contact_time, 0.2);
}

TEST(Recorder, SeesAThinWallBetweenTwoSteps) {
  LoopConfig config = Config();
  config.world.obstacles = {{.footprint = {{10.0, 0.0, 0.0}, 0.02, 4.0}}};
  Unicycle plant({});
  Recorder recorder(config, {});
  recorder.Sample(plant, 0.0);
  plant.state().pose.x = 20.0;  // 20 m in 0.2 s, 100 m/s
  recorder.Sample(plant, 0.2);
  // The first contact is between the time at which the front, 4 m ahead of the rear axle, reaches
  // the near side of the obstacle at 10 m, and the time at which the rear axle reaches this side.
  ASSERT_TRUE(recorder.contact_time());
  EXPECT_GE(*recorder.contact_time(), 0.0599);
  EXPECT_LE(*recorder.contact_time(), 0.1001);
  EXPECT_EQ(*recorder.BeginRow({}, {}, {}).clearance, 0.0);
}

TEST(Recorder, HasNoClearanceWithoutObstacles) {
  const LoopConfig config = Config();
  Unicycle plant({});
  Recorder recorder(config, {});
  recorder.Sample(plant, 0.0);
  EXPECT_FALSE(recorder.BeginRow({}, {}, {}).clearance);
}

TEST(Recorder, LogsConfigurationsAtTheirPeriod) {
  LoopConfig config = Config();
  Unicycle plant({});
  Recorder recorder(config, {});
  for (int step = 0; step <= 35; ++step) {
    plant.state().pose.x = step;
    recorder.Sample(plant, 0.01 * step);
  }
  const RunLog log = recorder.Finish(DriveStatus::kArrived);
  EXPECT_EQ(log.configurations.columns(), (std::vector<std::string>{"t_s", "x_m", "y_m"}));
  EXPECT_EQ(log.configurations.Column("x_m"), (std::vector<double>{0.0, 10.0, 20.0, 30.0}));
}

TEST(Recorder, LogsTheConfigurationAtTheEndOnce) {
  LoopConfig config = Config();
  Unicycle plant({});
  Recorder recorder(config, {});
  for (const double time : {0.0, 0.1, 0.15}) {
    plant.state().pose.x = time;
    recorder.Sample(plant, time);
  }
  const auto copied = [&] {
    return recorder.Copy(DriveStatus::kInterrupted, "", plant, 0.15).configurations.Column("x_m");
  };
  EXPECT_EQ(copied(), (std::vector<double>{0.0, 0.1, 0.15}));
  EXPECT_EQ(copied(), (std::vector<double>{0.0, 0.1, 0.15}));
  plant.state().pose.x = 0.2;
  recorder.Sample(plant, 0.2);
  recorder.SampleEnd(plant, 0.2);
  EXPECT_EQ(recorder.Finish(DriveStatus::kArrived).configurations.Column("x_m"),
            (std::vector<double>{0.0, 0.1, 0.2}));
}

TEST(Recorder, LogsWhereMovingObstaclesAreWhateverThePlantKnows) {
  LoopConfig config = Config();
  config.world.obstacles = {Box(), Box({2.0, -1.0})};
  config.configuration_columns = {"obstacle_1_y_m", "obstacle_1_x_m"};
  Unicycle plant({.pose = {7.0, 7.0, 0.0}});
  Recorder recorder(config, {});
  recorder.Sample(plant, 0.0);
  recorder.Sample(plant, 0.5);
  const RunLog log = recorder.Finish(DriveStatus::kArrived);
  EXPECT_EQ(log.configurations.Column("obstacle_1_x_m"), (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(log.configurations.Column("obstacle_1_y_m"), (std::vector<double>{-0.0, -0.5}));
}

TEST(Recorder, LogsNoConfigurationsWithoutNames) {
  LoopConfig config = Config();
  config.configuration_columns = {};
  Unicycle plant({});
  Recorder recorder(config, {});
  recorder.Sample(plant, 0.0);
  EXPECT_EQ(recorder.Finish(DriveStatus::kArrived).configurations.rows(), 0U);
}

TEST(Recorder, KeepsRowsChangesAndColumns) {
  Recorder recorder(Config(), {"a", "b"});
  VehicleState state;
  state.speed = 3.0;
  const LogRow row = recorder.BeginRow(state, {.steering = 0.1}, {1.0, 2.0});
  recorder.AddRow(row);
  recorder.AddPlanChange({.time = 2.0, .station = 6.0, .plan = {}});
  const RunLog log = recorder.Finish(DriveStatus::kStopped);
  ASSERT_EQ(log.rows.size(), 1U);
  EXPECT_EQ(log.rows[0].state.speed, 3.0);
  EXPECT_EQ(log.rows[0].command.steering, 0.1);
  EXPECT_EQ(log.rows[0].controller, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(log.controller_columns, (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(log.changes.size(), 1U);
  EXPECT_EQ(log.changes[0].station, 6.0);
  EXPECT_FALSE(log.contact_time);
}

/// A log of `count` rows at different times, each with a value of the controller.
RunLog LogOfRows(int count) {
  RunLog log{.plant = "unicycle", .controller_columns = {"gain"}, .configurations = Table({"t_s"})};
  for (int i = 0; i < count; ++i) {
    LogRow row{.controller = {0.1 * i}};
    row.state.time = 0.02 * i;
    row.valid = i != count - 1;  // adds a column that the first rows do not ask for
    log.rows.push_back(row);
  }
  return log;
}

TEST(Recorder, ReservesTheRowsOfTheRun) {
  LoopConfig config = Config();
  config.time_limit = 100.0;  // 5001 rows, one of them at the end
  Recorder recorder(config, {});
  for (int i = 0; i < 5001; ++i) {
    recorder.AddRow(recorder.BeginRow({}, {}, {}));
  }
  const RunLog log = recorder.Finish(DriveStatus::kTimeLimit);
  EXPECT_LE(log.rows.capacity(), 5002U);
  EXPECT_EQ(log.rows.size(), 5001U);
}

TEST(CsvParts, JoinToTheTextOfTheTable) {
  for (const int count : {0, 1, 1023, 1024, 1025, 2048, 3000}) {
    const RunLog log = LogOfRows(count);
    const auto next = CsvParts(log);
    std::string text;
    for (std::string part = next(); !part.empty(); part = next()) {
      EXPECT_LE(std::count(part.begin(), part.end(), '\n'), 1025) << "of " << count;
      text += part;
    }
    EXPECT_EQ(text, ToTable(log).ToCsv()) << count;
    EXPECT_EQ(next(), "") << count;
  }
}

}  // namespace
}  // namespace trackbed
