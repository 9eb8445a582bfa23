#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/folder_content.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::UnorderedElementsAre;
using testing::UnorderedElementsAreArray;

/// Runs the program with its output on a file system of a few kilobytes, which can be mounted only
/// in a private namespace.
class FullDisk : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(folder.path() / "disk");
    const Outcome mounted = Shell(folder, "unshare -Urm mount -t tmpfs none disk");
    if (mounted.code != 0) {
      GTEST_SKIP() << "no user namespace here that may mount a tmpfs: " << mounted.output;
    }
  }

  /// Runs `script` with a `disk` of that size and copies its final contents to `left`.
  [[nodiscard]] Outcome WithDisk(const std::string& size, const std::string& script) const {
    folder.Write("script", "mount -t tmpfs -o size=" + size + " none disk || exit 99\n" + script +
                               "\ncode=$?; cp -r disk left; exit $code\n");
    return Shell(folder, "unshare -Urm sh script");
  }

  TempFolder folder;
};

/// Expects every file in `folder` to equal that in `complete`, byte for byte.
void ExpectWhole(const fs::path& folder, const fs::path& complete) {
  for (const std::string& name : NamesOfEntries(folder)) {
    ASSERT_TRUE(fs::exists(complete / name)) << name << " is no file of the whole";
    EXPECT_EQ(ReadFile(folder / name), ReadFile(complete / name)) << name;
  }
}

/// Space of the files in `folder` on a disk with pages of 4 kB.
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

TEST_F(FullDisk, EndsARunInOneLineWithNothing) {
  // The disk has room for some files of the run, but not for its plan.csv of 127 kB. A run with
  // missing files must not look complete.
  const Outcome outcome = WithDisk("64k", TRACKBED_PROGRAM " run -o disk/r " + Winding());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output,
              MatchesRegex("cannot write disk/r/[a-z.]+: No space left on device\n"));
  EXPECT_THAT(NamesOfEntries(folder.path() / "left/r"), IsEmpty());
}

TEST_F(FullDisk, LeavesAnEarlierRunAsItWas) {
  Trackbed(folder, "run -q -o whole " + Winding());
  // The disk has room for one run, but not for a second run beside the first one.
  const Outcome outcome = WithDisk(std::to_string(KilobytesOf(folder.path() / "whole") + 8) + "k",
                                   TRACKBED_PROGRAM " run -q -o disk/r " + Winding() +
                                       "; cp disk/r/timing.json whole; " +
                                       TRACKBED_PROGRAM " run -q -o disk/r --mcap " + Winding());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output,
              MatchesRegex("(winding: [^\n]+\n)*cannot write disk/r/[a-z.]+: No space left on "
                           "device\n"));
  EXPECT_THAT(NamesOfEntries(folder.path() / "left/r"),
              UnorderedElementsAreArray(NamesOfEntries(folder.path() / "whole")));
  ExpectWhole(folder.path() / "left/r", folder.path() / "whole");
}

TEST_F(FullDisk, LeavesNothingOfARunWhoseMcapFoundNoRoom) {
  Trackbed(folder, "run -q -o whole " + Winding());
  const Outcome outcome = WithDisk(std::to_string(KilobytesOf(folder.path() / "whole") + 8) + "k",
                                   TRACKBED_PROGRAM " run --mcap -o disk/r " + Winding());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.output, "cannot write disk/r/run.mcap: No space left on device\n");
  EXPECT_THAT(NamesOfEntries(folder.path() / "left/r"), IsEmpty());
}

TEST_F(FullDisk, LeavesAnEarlierPlanAsItWas) {
  // The plan of a short route fits; that of the whole route does not.
  const std::string route = " --set 'mission.waypoints=[[0, 0], [20, 0], [40, 4]]'";
  const std::string plan = TRACKBED_PROGRAM " plan -q -o disk " + ScenarioFile("winding");
  const Outcome outcome = WithDisk("64k", plan + route + " && " + plan);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.output, "cannot write disk/plan.csv: No space left on device\n");
  EXPECT_THAT(NamesOfEntries(folder.path() / "left"),
              UnorderedElementsAre("plan.csv", "plan.json", "schedule.csv", "manifest.json"));
  Trackbed(folder, "plan -q -o whole " + ScenarioFile("winding") + route);
  ExpectWhole(folder.path() / "left", folder.path() / "whole");
}

TEST_F(FullDisk, LeavesNoPieceOfASweep) {
  folder.Write("study.yaml", "schema: 1\nname: study\nscenario: " + ScenarioFile("winding") +
                                 "\nset: {drive.time_limit: 0.1, drive.plants: [kinematic]}\n"
                                 "vary: {mission.speed: [1, 2]}\n"
                                 "outputs: [metrics.kinematic.distance]\n");
  Trackbed(folder, "sweep -q study.yaml -o whole");
  // The sweep needs six pages, one of them for the list of files that it has begun. There is room
  // for only one page, which holds the records. The sweep can resume from these records.
  const std::string sweep = TRACKBED_PROGRAM " sweep -q study.yaml -o disk/s";
  const Outcome part = WithDisk("4k", sweep);
  EXPECT_EQ(part.code, 2);
  EXPECT_EQ(part.output, "cannot write disk/s/.written: No space left on device\n");
  EXPECT_THAT(NamesOfEntries(folder.path() / "left/s"), UnorderedElementsAre("sweep.records"));
  fs::remove_all(folder.path() / "left");
  // The disk has room for one sweep and its list of files to remove, but not for a second sweep.
  // The first result stays unchanged.
  const Outcome second =
      WithDisk("24k", sweep + " && " + sweep + " --restart --set drive.time_limit=0.2");
  EXPECT_EQ(second.code, 2);
  EXPECT_EQ(second.output, "cannot write disk/s/sweep.json: No space left on device\n");
  EXPECT_THAT(NamesOfEntries(folder.path() / "left/s"),
              UnorderedElementsAre("sweep.csv", "sweep.json", "sweep.records", "manifest.json"));
  fs::remove(folder.path() / "left/s/sweep.records");  // of the second sweep
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
  EXPECT_THAT(NamesOfEntries(folder.path() / "left"), IsEmpty());
}

TEST_F(FullDisk, KeepsTheFramesThatFoundRoom) {
  Trackbed(folder, "run -q -o r " + Winding());
  const std::string film = "render r --size 128x72 --fps 5 -o ";  // six frames of 5 kB
  const Outcome outcome = WithDisk("24k", TRACKBED_PROGRAM " " + film + "disk/f.png");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output,
              MatchesRegex("cannot write disk/f_0000[0-9].png: No space left on device\n"));
  EXPECT_THAT(NamesOfEntries(folder.path() / "left"), Contains("f_00000.png"));
  Trackbed(folder, film + "whole/f.png");
  ExpectWhole(folder.path() / "left", folder.path() / "whole");
}

TEST_F(FullDisk, KeepsTheFramesOfAnEarlierFilm) {
  Trackbed(folder, "run -q -o r " + Winding());
  const std::string film = "render r --size 128x72 -o ";
  const Outcome outcome = WithDisk("24k", TRACKBED_PROGRAM " " + film +
                                              "disk/f.png -q --fps 1 && " TRACKBED_PROGRAM " " +
                                              film + "disk/f.png --fps 5");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output,
              MatchesRegex("cannot write disk/f_0000[0-9].png: No space left on device\n"));
  Trackbed(folder, film + "whole/f.png --fps 1");
  EXPECT_THAT(NamesOfEntries(folder.path() / "left"),
              UnorderedElementsAre("f_00000.png", "f_00001.png"));
  ExpectWhole(folder.path() / "left", folder.path() / "whole");
}

}  // namespace
}  // namespace trackbed
