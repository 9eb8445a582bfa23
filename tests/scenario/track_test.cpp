#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "tests/track/rings.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/scenario/initial_state.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/plant.h"
#include "trackbed/track/track_file.h"

// Tests the section mission.track. tests/data/bad contains invalid sections.
namespace trackbed {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kLapScenario =
    "schema: 1\n"
    "name: laps\n"
    "mission: {speed: 10, track: {file: ring.csv, laps: 2, smoothing: 30}}\n"
    "plan: {method: center_line}\n";

std::vector<TrackPoint> Ring() {
  return RingPoints(40.0, 50, 4.0, 3.0);
}

TEST(MissionTrack, IsReadAndStartsOnItsLine) {
  const TempFolder folder;
  folder.Write("ring.csv", TrackCsv(Ring()));
  const Scenario scenario = ParseScenario(kLapScenario, "laps.yaml", folder.path());
  ASSERT_TRUE(scenario.mission.track && scenario.mission.track->data);
  EXPECT_EQ(scenario.mission.track->laps, 2);
  EXPECT_EQ(scenario.mission.track->data->points(), Ring());
  EXPECT_EQ(scenario.mission.track->data->smoothing(), 30.0);
  const StartState start = InitialState(scenario);
  EXPECT_EQ(start.pose, scenario.mission.track->data->At(0.0).pose);
  EXPECT_EQ(start.speed, 10.0);  // a flying start
  const Scenario at_rest =
      ParseScenario(kLapScenario, "laps.yaml", folder.path(), {"mission.start={x: 38, speed: 0}"});
  EXPECT_EQ(InitialState(at_rest).pose.x, 38.0);
  EXPECT_EQ(InitialState(at_rest).speed, 0.0);
}

TEST(MissionTrack, StartsWithTheSteeringOfTheTrack) {
  const TempFolder folder;
  folder.Write("ring.csv", TrackCsv(Ring()));
  for (const char* method : {"center_line", "minimum_curvature"}) {
    const auto steering = [&](const std::vector<Override>& more) {
      std::vector<Override> overrides{fmt::format("plan.method={}", method)};
      overrides.insert(overrides.end(), more.begin(), more.end());
      return InitialState(ParseScenario(kLapScenario, "laps.yaml", folder.path(), overrides),
                          ReferenceCar())
          .steering;
    };
    // The track is a ring with a radius of 40 m. A car 2 m to the left of the center line is on a
    // circle with a radius of 38 m. Smoothing the center line reduces its radius by 0.02 m.
    EXPECT_NEAR(steering({}), std::atan(2.7 / 40.0), Tolerance(1e-4));
    EXPECT_NEAR(steering({"mission.start={x: 38}"}), std::atan(2.7 / 38.0), Tolerance(1e-4));
    EXPECT_EQ(steering({"mission.start={steering: -0.1}"}), -0.1);
  }
}

TEST(MissionTrack, ResolvesToItsOwnFile) {
  const TempFolder folder;
  std::filesystem::create_directories(folder.path() / "data");
  folder.Write("data/ring.csv", TrackCsv(Ring()));
  const Scenario scenario =
      ParseScenario(kLapScenario, "laps.yaml", folder.path(), {"mission.track.file=data/ring.csv"});
  const std::string resolved = ResolvedYaml(scenario);
  EXPECT_THAT(resolved, HasSubstr("file: track.csv"));
  const std::filesystem::path run = folder.path() / "run";
  std::filesystem::create_directories(run);
  WriteFileAtomically(run / kTrackCsv, TrackCsv(scenario.mission.track->data->points()));
  const Scenario again = ParseScenario(resolved, "resolved.yaml", run);
  EXPECT_EQ(ResolvedYaml(again), resolved);
  EXPECT_EQ(again.mission.track->data->points(), Ring());
}

TEST(MissionTrack, MayLieInAFolderThatIsAllowed) {
  const TempFolder folder;
  std::filesystem::create_directories(folder.path() / "here");
  std::filesystem::create_directories(folder.path() / "there");
  const std::filesystem::path file = folder.Write("there/ring.csv", TrackCsv(Ring()));
  const auto read = [&](const std::vector<std::filesystem::path>& allowed) {
    return ParseScenario(kLapScenario, "laps.yaml", folder.path() / "here",
                         {"mission.track.file=" + file.string()}, {}, allowed);
  };
  EXPECT_THROW(read({}), InputError);
  EXPECT_EQ(read({folder.path() / "there"}).mission.track->data->points(), Ring());
}

TEST(MissionTrack, ReportsMistakesOfItsFileBesideThoseOfTheScenario) {
  const TempFolder folder;
  std::vector<TrackPoint> points = Ring();
  points[3].width_left = -1.0;
  folder.Write("ring.csv", TrackCsv(points));
  try {
    ParseScenario(kLapScenario, "laps.yaml", folder.path(), {"control={method: no_such}"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no_such"));
    EXPECT_THAT(error.what(), HasSubstr("ring.csv:5: w_tr_left_m: -1 is out of range"));
    EXPECT_THAT(error.what(), Not(HasSubstr("mission.track: missing")));
  }
}

}  // namespace
}  // namespace trackbed
