#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::Not;
using testing::UnorderedElementsAre;

/// Runs the program with its output on a file system of a few kilobytes, which only a namespace of
/// our own may mount.
class FullDisk : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(folder.path() / "disk");
    const Outcome mounted = Shell(folder, "unshare -Urm mount -t tmpfs none disk");
    if (mounted.code != 0) {
      GTEST_SKIP() << "no user namespace here that may mount a tmpfs: " << mounted.output;
    }
  }

  /// Runs `script` with `disk` of that size, and copies to `left` what is on it in the end.
  [[nodiscard]] Outcome WithDisk(const std::string& size, const std::string& script) const {
    folder.Write("script", "mount -t tmpfs -o size=" + size + " none disk || exit 99\n" + script +
                               "\ncode=$?; cp -r disk left; exit $code\n");
    return Shell(folder, "unshare -Urm sh script");
  }

  TempFolder folder;
};

std::vector<std::string> NamesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

/// What is in `folder` is byte for byte what is in `complete`.
void ExpectWhole(const fs::path& folder, const fs::path& complete) {
  for (const std::string& name : NamesIn(folder)) {
    ASSERT_TRUE(fs::exists(complete / name)) << name << " is no file of the whole";
    EXPECT_EQ(ReadFile(folder / name), ReadFile(complete / name)) << name;
  }
}

/// What the files take on a tmpfs.
std::uintmax_t KilobytesOf(const fs::path& folder) {
  std::uintmax_t kilobytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    kilobytes += entry.is_regular_file() ? (entry.file_size() + 4095) / 4096 * 4 : 0;
  }
  return kilobytes;
}

std::string Winding() {
  return ScenarioFile("winding") + " --set drive.time_limit=1 'expect={}'";
}

TEST_F(FullDisk, EndsARunInOneLineAndLeavesTheEarlierOneAsItWas) {
  const std::string run = TRACKBED_PROGRAM " run -q -o disk/r ";
  const std::string earlier =
      ScenarioFile("three_turns") + " --set drive.time_limit=0.1 'expect={}' ";
  Trackbed(folder, "run -q -o whole " + earlier);
  // Room for a run of a tenth of a second, but not for a plan.csv of 127 kB beside it.
  const Outcome outcome = WithDisk(std::to_string(KilobytesOf(folder.path() / "whole") + 100) + "k",
                                   run + earlier + "; cp -r disk/r before; " + run + Winding());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output,
              MatchesRegex("cannot write disk/r/[a-z.]+: No space left on device\n"));
  ExpectWhole(folder.path() / "left/r", folder.path() / "before");
  EXPECT_THAT(NamesIn(folder.path() / "left/r"), Contains("metrics.json"));
}

TEST_F(FullDisk, LeavesNothingOfARunWhoseMcapFoundNoRoom) {
  Trackbed(folder, "run -q -o whole " + Winding());
  const std::uintmax_t kilobytes = KilobytesOf(folder.path() / "whole") + 8;  // to spare
  const Outcome outcome = WithDisk(std::to_string(kilobytes) + "k",
                                   TRACKBED_PROGRAM " run --mcap -o disk/r " + Winding());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.output, "cannot write disk/r/run.mcap: No space left on device\n");
  EXPECT_THAT(NamesIn(folder.path() / "left/r"), IsEmpty());
}

TEST_F(FullDisk, LeavesAnEarlierPlanAsItWas) {
  // The plan of a short route fits; that of the whole one does not.
  const std::string route = " --set 'mission.waypoints=[[0, 0], [20, 0], [40, 4]]'";
  const std::string plan = TRACKBED_PROGRAM " plan -q -o disk " + ScenarioFile("winding");
  const Outcome outcome = WithDisk("64k", plan + route + " && " + plan);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.output, "cannot write disk/plan.csv: No space left on device\n");
  EXPECT_THAT(NamesIn(folder.path() / "left"),
              UnorderedElementsAre("plan.csv", "plan.json", "schedule.csv"));
  Trackbed(folder, "plan -q -o whole " + ScenarioFile("winding") + route);
  ExpectWhole(folder.path() / "left", folder.path() / "whole");
}

TEST_F(FullDisk, LeavesNoPieceOfASweep) {
  folder.Write("study.yaml", "schema: 1\nname: study\nscenario: " + ScenarioFile("winding") +
                                 "\nset: {drive.time_limit: 0.1, drive.plants: [kinematic]}\n"
                                 "vary: {mission.speed: [1, 2]}\n"
                                 "outputs: [metrics.kinematic.distance]\n");
  Trackbed(folder, "sweep -q study.yaml -o whole");
  // Of the two pages that the sweep takes there is room for one.
  const std::string sweep = TRACKBED_PROGRAM " sweep -q study.yaml -o disk/s";
  const Outcome half = WithDisk("4k", sweep);
  EXPECT_EQ(half.code, 2);
  EXPECT_EQ(half.output, "cannot write disk/s/sweep.json: No space left on device\n");
  EXPECT_THAT(NamesIn(folder.path() / "left/s"), IsEmpty());
  fs::remove_all(folder.path() / "left");
  // And none for another sweep: the earlier one stays as it was.
  const Outcome none = WithDisk("8k", sweep + " && " + sweep + " --set drive.time_limit=0.2");
  EXPECT_EQ(none.code, 2);
  EXPECT_EQ(none.output, "cannot write disk/s/sweep.csv: No space left on device\n");
  EXPECT_THAT(NamesIn(folder.path() / "left/s"), UnorderedElementsAre("sweep.csv", "sweep.json"));
  ExpectWhole(folder.path() / "left/s", folder.path() / "whole");
}

TEST_F(FullDisk, LeavesNoPieceOfAFilm) {
  if (!HasVideo(folder)) {
    GTEST_SKIP() << "built without video";
  }
  Trackbed(folder, "run -q -o r " + Winding());
  const Outcome outcome =
      WithDisk("4k", TRACKBED_PROGRAM " render r --size 320x180 --fps 10 -o disk/v.mp4");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.output, "cannot write disk/v.mp4: No space left on device\n");
  EXPECT_THAT(NamesIn(folder.path() / "left"), IsEmpty());
}

TEST_F(FullDisk, KeepsTheFramesThatFoundRoom) {
  Trackbed(folder, "run -q -o r " + Winding());
  const std::string film = "render r --size 128x72 --fps 5 -o ";  // six frames of 5 kB
  const Outcome outcome = WithDisk("24k", TRACKBED_PROGRAM " " + film + "disk/f.png");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output,
              MatchesRegex("cannot write disk/f_0000[0-9].png: No space left on device\n"));
  EXPECT_THAT(NamesIn(folder.path() / "left"), Contains("f_00000.png"));
  Trackbed(folder, film + "whole/f.png");
  ExpectWhole(folder.path() / "left", folder.path() / "whole");
}

}  // namespace
}  // namespace trackbed
