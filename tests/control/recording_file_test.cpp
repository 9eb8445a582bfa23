#include "trackbed/control/recording_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"
#include "trackbed/control/playback.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace recording_file_test {

using testing::ElementsAre;

Recording Read(const std::string& csv, PlaybackAxis by = PlaybackAxis::kTime,
               const RecordingColumns& columns = {}) {
  const TempFolder folder;
  return ReadRecording(folder.Write("r.csv", csv), by, columns);
}

std::string ErrorMessages(const std::string& csv, PlaybackAxis by = PlaybackAxis::kTime,
                          const RecordingColumns& columns = {}) {
  const TempFolder folder;
  try {
    ReadRecording(folder.Write("r.csv", csv), by, columns);
  } catch (const InputError& error) {
    std::string text = error.what();
    const std::string prefix = folder.path().string() + "/";
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
      text.erase(at, prefix.size());
    }
    return text;
  }
  return "no problem";
}

TEST(ReadRecording, TakesItsColumnsInAnyOrderAndNoOthers) {
  const Recording recording = Read(
      "gear,speed_mps,t_s,note,steering_rad\n"
      "D,10,0,start,0\n"
      "D,11,0.5,,0.02\n"
      "N,12,1.25,end,-0.01\n");
  EXPECT_THAT(recording.steering.knots,
              ElementsAre(Vec2(0.0, 0.0), Vec2(0.5, 0.02), Vec2(1.25, -0.01)));
  EXPECT_THAT(recording.speed.knots,
              ElementsAre(Vec2(0.0, 10.0), Vec2(0.5, 11.0), Vec2(1.25, 12.0)));
  EXPECT_TRUE(recording.acceleration.empty());
}

TEST(ReadRecording, NeedsNeitherSpeedNorAcceleration) {
  const Recording recording = Read("t_s,steering_rad\n0,0.1\n");
  EXPECT_THAT(recording.steering.knots, ElementsAre(Vec2(0.0, 0.1)));
  EXPECT_TRUE(recording.speed.empty());
  EXPECT_TRUE(recording.acceleration.empty());
}

TEST(ReadRecording, TakesOtherNames) {
  const RecordingColumns columns{
      .time = "Time", .distance = {}, .steering = "delta", .speed = {}, .acceleration = "ax"};
  const Recording recording =
      Read("delta,ax,Time,speed_mps\n0.1,-2,0,x\n", PlaybackAxis::kTime, columns);
  EXPECT_THAT(recording.steering.knots, ElementsAre(Vec2(0.0, 0.1)));
  EXPECT_TRUE(recording.speed.empty());
  EXPECT_THAT(recording.acceleration.knots, ElementsAre(Vec2(0.0, -2.0)));
}

TEST(ReadRecording, RunsOverTheDistanceIfAsked) {
  const Recording recording =
      Read("t_s,s_m,steering_rad,speed_mps\n0,1,0.1,4\n0,2,0.2,0\n", PlaybackAxis::kDistance);
  EXPECT_THAT(recording.steering.knots, ElementsAre(Vec2(1.0, 0.1), Vec2(2.0, 0.2)));
  EXPECT_THAT(recording.speed.knots, ElementsAre(Vec2(1.0, 4.0), Vec2(2.0, 0.0)));
}

TEST(ReadRecording, TakesFilesAsOtherProgramsWriteThem) {
  const Recording recording = Read("\xEF\xBB\xBFt_s, steering_rad\r\n0, 0\r\n1, 1e-1\r\n\r\n");
  EXPECT_THAT(recording.steering.knots, ElementsAre(Vec2(0.0, 0.0), Vec2(1.0, 0.1)));
}

TEST(ReadRecording, ChoosesBetweenSpeedAndAcceleration) {
  const std::string both = "t_s,steering_rad,speed_mps,acceleration_mps2\n0,0,10,1\n";
  EXPECT_EQ(ErrorMessages(both),
            "r.csv:1: has both 'speed_mps' and 'acceleration_mps2'; choose one in control.columns");
  RecordingColumns columns;
  columns.speed = "speed_mps";
  EXPECT_TRUE(Read(both, PlaybackAxis::kTime, columns).acceleration.empty());
  EXPECT_EQ(Read(both, PlaybackAxis::kTime, columns).speed.At(0.0), 10.0);
  columns.acceleration = "acceleration_mps2";
  EXPECT_EQ(ErrorMessages(both, PlaybackAxis::kTime, columns),
            "columns: give speed or acceleration, not both");
  columns.speed.reset();
  EXPECT_TRUE(Read(both, PlaybackAxis::kTime, columns).speed.empty());
  EXPECT_EQ(Read(both, PlaybackAxis::kTime, columns).acceleration.At(0.0), 1.0);
}

TEST(ReadRecording, PlacesWhatCannotBeRead) {
  EXPECT_EQ(ErrorMessages("t_s,steering_rad\n0,\n1,x\n2,nan\n3,inf\n4\n"),
            "r.csv:2: cell 2 (steering_rad): '' is not a number\nr.csv:3: cell 2 (steering_rad): "
            "'x' is not a number\nr.csv:4: cell 2 (steering_rad): 'nan' is not a finite "
            "number\nr.csv:5: cell 2 (steering_rad): 'inf' is not a finite number\nr.csv:6: cell 2 "
            "(steering_rad): missing; 1 cell, the header has 2");
  EXPECT_EQ(ErrorMessages("t_s,steering_deg\n0,0\n"),
            "r.csv:1: no column 'steering_rad'; did you mean 'steering_deg'?");
  EXPECT_EQ(ErrorMessages("t_s,steering_rad\n"), "r.csv:1: no rows after the header");
  EXPECT_THROW(ReadRecording("/nonexistent/r.csv", PlaybackAxis::kTime), RunError);
}

TEST(ReadRecording, WantsTimesThatRiseStrictly) {
  EXPECT_EQ(ErrorMessages("t_s,steering_rad\n0,0\n0.5,0\n0.5,0\n\n0.25,0\n"),
            "r.csv:4: t_s: 0.5 must be above the previous row's 0.5\nr.csv:6: t_s: 0.25 must be "
            "above the previous row's 0.5");
}

TEST(ReadRecording, TellsProblemsInTheOrderOfTheFileAndNotAllOfThem) {
  std::string csv = "t_s,steering_rad,speed_mps\n";
  for (int i = 0; i < 30; ++i) {
    csv += fmt::format("{},0,{}\n", i, -1 - i);
  }
  csv += "30,2,10\n";
  const std::string told = ErrorMessages(csv);
  EXPECT_THAT(told, testing::StartsWith("r.csv:2: speed_mps: -1 is"));
  EXPECT_THAT(told, testing::HasSubstr("\nr.csv:21: speed_mps: -20 is"));
  EXPECT_THAT(told, testing::EndsWith("\nr.csv: and 11 more problems"));
}

TEST(ReadRecording, KnowsWhatACarCanBeAskedFor) {
  EXPECT_EQ(ErrorMessages("t_s,steering_rad,speed_mps\n0,4.5,-1\n1,0,101\n"),
            "r.csv:2: steering_rad: 4.5 is out of range; must be at least -1.5 and at most 1.5\n"
            "r.csv:2: speed_mps: -1 is out of range; must be at least 0 and at most 100\n"
            "r.csv:3: speed_mps: 101 is out of range; must be at least 0 and at most 100");
  // A recording over distance may command the speed 0 only in its last row, because the car would
  // stop and never advance to the next row.
  EXPECT_EQ(
      ErrorMessages("s_m,steering_rad,speed_mps\n0,0,0\n1,0,2\n2,0,0\n", PlaybackAxis::kDistance),
      "r.csv:2: speed_mps: 0 is out of range; must be above 0 and at most 100");
}

}  // namespace recording_file_test
}  // namespace trackbed
