#include "trackbed/recording/record_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

RecordedDrive Drive() {
  RecordedDrive drive{.name = "drive", .period = 0.1, .has_steering_command = true};
  for (int i = 0; i < 3; ++i) {
    const double n = i + 1.0 / 3.0;
    drive.samples.push_back({.time = 0.1 * i,
                             .pose = {n, 2.0 * n, -n},
                             .velocity_V = {3.0 * n, 0.1 * n},
                             .yaw_rate = 0.2 * n,
                             .acceleration_V = {-n, 0.5 * n},
                             .yaw_acceleration = 0.7 * n,
                             .steering_command = 0.01 * n,
                             .valid = i != 1});
  }
  return drive;
}

TEST(RecordCsv, IsReadBackToTheLastDigit) {
  const TempFolder folder;
  const RecordedDrive drive = Drive();
  const RecordedDrive read = ReadRecordCsv(folder.Write("drive.csv", RecordCsv(drive)));
  EXPECT_EQ(read.name, "drive");
  EXPECT_EQ(read.period, 0.1);
  EXPECT_TRUE(read.has_steering_command);
  EXPECT_FALSE(read.has_steering);
  EXPECT_FALSE(read.has_throttle);
  ASSERT_EQ(read.samples.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const RecordedSample& a = drive.samples[i];
    const RecordedSample& b = read.samples[i];
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.pose, b.pose);
    EXPECT_EQ(a.velocity_V, b.velocity_V);
    EXPECT_EQ(a.yaw_rate, b.yaw_rate);
    EXPECT_EQ(a.acceleration_V, b.acceleration_V);
    EXPECT_EQ(a.yaw_acceleration, b.yaw_acceleration);
    EXPECT_EQ(a.steering_command, b.steering_command);
    EXPECT_EQ(a.valid, b.valid);
  }
}

std::string Problems(const std::string& csv) {
  const TempFolder folder;
  try {
    ReadRecordCsv(folder.Write("r.csv", csv));
  } catch (const InputError& error) {
    const Problem& problem = error.problems().front();
    return std::to_string(problem.line) + ": " + problem.WithoutPlace();
  }
  return "no problem";
}

TEST(RecordCsv, HasItsPlacesNearEachOther) {
  RecordedDrive drive = Drive();
  drive.samples[1].pose.x = 200000.0;
  drive.samples[0].pose.x = 0.0;
  drive.samples[2].pose.x = 0.0;
  EXPECT_EQ(Problems(RecordCsv(drive)), "no problem");
  drive.samples[2].pose.x = -1.0;
  EXPECT_THAT(Problems(RecordCsv(drive)),
              testing::AllOf(testing::HasSubstr("the positions extend over 200001 m"),
                             testing::HasSubstr(" at line 3 to (-1, "),
                             testing::HasSubstr(" at line 4; is a coordinate wrong?")));
}

TEST(RecordCsv, MustBeUniform) {
  RecordedDrive drive = Drive();
  drive.samples[1].time = 0.11;
  EXPECT_EQ(Problems(RecordCsv(drive)), "3: t_s: 0.11 is not on a uniform grid from 0 on");
  drive = Drive();
  drive.samples.resize(1);
  EXPECT_EQ(Problems(RecordCsv(drive)), "0: 1 rows; must be at least 2");
  EXPECT_THAT(Problems("t_s,x_m\n0,0\n"), testing::HasSubstr("no column 'valid'"));
}

}  // namespace
}  // namespace trackbed
