// Runs the program through the shell: exit codes, messages, written files, locks and
// signals.

#include "tests/cli/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"
#include "trackbed/core/table.h"

namespace trackbed {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Program, NamesItsVersions) {
  const TempFolder folder;
  const Outcome outcome = Trackbed(folder, "--version");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.output,
              testing::MatchesRegex("Trackbed 0\\.1\\.0.*\nMuJoCo [0-9]+\\.[0-9.]+\nNLopt [0-9.]+\n"
                                    "video (off|H\\.264 \\(libavcodec [0-9.]+\\))\n"));
}

TEST(Program, HelpsAndRefuses) {
  const TempFolder folder;
  EXPECT_EQ(Trackbed(folder, "--help").code, 0);
  EXPECT_EQ(Trackbed(folder, "").code, 2);
  for (const char* verb : {"run", "plan", "render"}) {
    const Outcome outcome = Trackbed(folder, std::string(verb) + " --help");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.output, HasSubstr("--out"));
    EXPECT_EQ(Trackbed(folder, verb).code, 2);  // needs an argument
    EXPECT_EQ(Trackbed(folder, std::string(verb) + " --oops").code, 2);
  }
  const Outcome unknown = Trackbed(folder, "rum");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_EQ(unknown.output, "unknown verb 'rum'; did you mean 'run'?\n");
}

TEST(Program, RunsAScenario) {
  const TempFolder folder;
  const Outcome outcome =
      Trackbed(folder, "run " + ScenarioFile("winding") + " --plant kinematic --set 'expect={}'");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, StartsWith("winding: passed, in out/winding\n"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/winding/kinematic.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/winding/mujoco.csv"));
  // The output is a pipe, so it has no progress bar and no color.
  EXPECT_EQ(outcome.output.find('\r'), std::string::npos);
  EXPECT_EQ(
      Trackbed(folder, "run -q --plant kinematic --set 'expect={}' -o x " + ScenarioFile("winding"))
          .output,
      "");
}

TEST(Program, FailedExpectationsAreExitCodeThree) {
  const TempFolder folder;
  const Outcome outcome =
      Trackbed(folder, "run " + ScenarioFile("winding") +
                           " --plant kinematic --set 'expect={max_cross_track: 0.001}'");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.output,
              testing::ContainsRegex("maximum cross-track error 0\\.[0-9]+ m exceeds 0\\.001 m"));
}

TEST(Program, MissionWithoutAPlanIsExitCodeThree) {
  const TempFolder folder;
  const std::string set = " --set 'mission.waypoints=[[0, 0], [10, 0], [10, 10]]'";
  const Outcome run = Trackbed(folder, "run " + ScenarioFile("winding") + set);
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.output, HasSubstr("no plan (turn_too_tight): turn of 90 deg at waypoint 1"));
  const Outcome plan = Trackbed(folder, "plan " + ScenarioFile("winding") + set);
  EXPECT_EQ(plan.code, 3);
  EXPECT_THAT(ReadFile(folder.path() / "out/winding/plan.json"), HasSubstr("turn_too_tight"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/winding/plan.csv"));
}

TEST(Program, APartialPlanIsToldAndNotPassed) {
  const TempFolder folder;
  folder.Write("wall.yaml",
               "schema: 1\nname: wall\nmission: {speed: 3, waypoints: [[0, 0], [50, 0]]}\n"
               "world: {obstacles: [{box: {x: 30, y: 0, yaw: 0, length: 1, width: 200, height: "
               "1}}]}\n"
               "plan: {method: rrt, trees: 3, iterations: 500, partial: true}\n"
               "drive: {plants: [kinematic]}\n");
  const Outcome plan = Trackbed(folder, "plan wall.yaml");
  EXPECT_EQ(plan.code, 0) << plan.output;
  EXPECT_THAT(plan.output, testing::ContainsRegex("\n  partial: ends [0-9.]+ m from waypoint 1, "));
  const Outcome run = Trackbed(folder, "run wall.yaml");
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.output, StartsWith("wall: FAILED, in out/wall\n"));
  EXPECT_THAT(run.output, HasSubstr("\n  kinematic  partial after "));
  EXPECT_THAT(run.output, HasSubstr("(the plan ends "));
}

TEST(Program, BadInputIsExitCodeTwoAndTouchesNothing) {
  const TempFolder folder;
  folder.Write("bad.yaml", "schema: 1\nname: bad\nmission: {sped: 3}\n");
  const Outcome outcome = Trackbed(folder, "run bad.yaml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.output,
            "bad.yaml:1:1: plan: missing; the controller preview needs a plan\nbad.yaml:3:10: "
            "mission.duration: missing; required without a plan\nbad.yaml:3:11: mission.sped: "
            "unknown key 'sped'; did you mean 'speed'?\n");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
  const Outcome missing = Trackbed(folder, "run none.yaml");
  EXPECT_EQ(missing.code, 2);
  EXPECT_EQ(missing.output, "cannot read none.yaml: No such file or directory\n");
}

TEST(Program, UnwritableOutputIsOneClearLine) {
  const TempFolder folder;
  folder.Write("taken", "a file");
  const Outcome outcome = Trackbed(folder, "run " + ScenarioFile("winding") + " -o taken/here");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.output, "cannot create the folder taken/here: Not a directory\n");
}

TEST(Program, PlansARoute) {
  const TempFolder folder;
  const Outcome outcome = Trackbed(folder, "plan " + ScenarioFile("three_turns") + " -o p");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, StartsWith("three_turns: planned 138."));
  EXPECT_THAT(ReadFile(folder.path() / "p/plan.json"), HasSubstr("\"radius_m\": 16.83068"));
}

TEST(Program, FilmsAFinishedRunFromItsFolder) {
  const TempFolder folder;
  if (!HasVideo(folder)) {
    GTEST_SKIP() << "built without video";
  }
  const Outcome run = Trackbed(
      folder, "run " + ScenarioFile("winding") + " -o r --set drive.time_limit=1 'expect={}'");
  EXPECT_EQ(run.code, 3);  // the car does not arrive within a second
  const Outcome film = Trackbed(folder, "render r --size 320x180 --fps 10 --camera top");
  EXPECT_EQ(film.code, 0) << film.output;
  EXPECT_EQ(film.output, "r/video.mp4\n");
  EXPECT_GT(std::filesystem::file_size(folder.path() / "r/video.mp4"), 1000U);
}

TEST(Program, MakesFramesWithOrWithoutVideo) {
  const TempFolder folder;
  Trackbed(folder, "run " + ScenarioFile("winding") + " -o r --set drive.time_limit=0.2");
  const Outcome frames = Trackbed(folder, "render r --size 128x72 --fps 5 -o p/f.png");
  EXPECT_EQ(frames.code, 0) << frames.output;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "p/f_00001.png"));
  const Outcome cut =
      Trackbed(folder, "render r --size 128x72 --fps 5 --from 0.1 --to 0.2 -o q/f.png");
  EXPECT_EQ(cut.code, 0) << cut.output;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "q/f_00000.png"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "q/f_00001.png"));
  const Outcome one = Trackbed(folder, "render r --size 128x72 --at 0.2");
  EXPECT_EQ(one.output, "r/picture.png\n");
  EXPECT_EQ(ReadFile(folder.path() / "r/picture.png"), ReadFile(folder.path() / "p/f_00001.png"));
}

TEST(Program, SaysAtOnceThatItWasBuiltWithoutVideo) {
  const TempFolder folder;
  if (HasVideo(folder)) {
    GTEST_SKIP() << "built with video";
  }
  const Outcome run = Trackbed(folder, "run " + ScenarioFile("winding") + " --video");
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.output,
            "out/winding/video.mp4: this Trackbed was built without video (TRACKBED_VIDEO=OFF); a "
            "film is made as .png (frames)\n");
  EXPECT_TRUE(folder.Names().empty());  // fails before the simulation
}

TEST(Program, RefusesToFilmWhatIsNoRun) {
  const TempFolder folder;
  EXPECT_EQ(Trackbed(folder, "render nowhere").code, 2);
  EXPECT_EQ(Trackbed(folder, "render . --size 12").output,
            "--size: '12' is not of the form 1280x720\n");
}

TEST(Program, KeepsRunsOfOneNameApart) {
  const TempFolder folder;
  folder.Write("a/w.yaml", ReadFile(ScenarioFile("winding")));
  folder.Write("b/w.yaml", ReadFile(ScenarioFile("winding")));
  const Outcome outcome = Trackbed(folder, "run a/w.yaml b/w.yaml -o o");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(
      outcome.output,
      "b/w.yaml: name: the scenario name 'winding' is used twice; both would write to o/winding\n");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "o"));
}

TEST(Program, NeverWritesOutsideItsFolder) {
  const TempFolder folder;
  for (const char* name : {"../escaped", "/tmp/escaped", ".", "a/b", ".hidden"}) {
    const Outcome outcome = Trackbed(
        folder, "run " + ScenarioFile("winding") + " --set 'name=" + std::string(name) + "'");
    EXPECT_EQ(outcome.code, 2) << name;
    EXPECT_THAT(outcome.output, HasSubstr("is not a valid folder name")) << name;
  }
  EXPECT_TRUE(folder.Names().empty());
}

TEST(Program, SaysSoWhenNobodyCanReadItsOutput) {
  const TempFolder folder;
  EXPECT_EQ(Trackbed(folder, "--version > /dev/full").code, 2);
  for (const char* verb : {"list", "model prius", "list planners"}) {
    const Outcome outcome = Trackbed(folder, std::string(verb) + " > /dev/full");
    EXPECT_EQ(outcome.code, 2) << verb;
    EXPECT_EQ(outcome.output, "cannot write to standard output\n") << verb;
  }
  EXPECT_EQ(Trackbed(folder, "run none.yaml 2>&-").code, 2);
}

// With a standard stream closed, the next opened file would get its descriptor, and printed text
// would end up in that file.
TEST(Program, WritesFilesOnlyWhereStreamsAreClosed) {
  const TempFolder folder;
  Trackbed(folder, "run -q -o r --set drive.time_limit=0.1 -- " + ScenarioFile("winding"));
  ASSERT_EQ(Trackbed(folder, "report r -o page.html").code, 0);
  const std::string page = ReadFile(folder.path() / "page.html");
  for (const char* closed : {"<&-", ">&-", "2>&-", "<&- >&-", "<&- >&- 2>&-"}) {
    const bool is_told = std::string(closed).find(" >&-") == std::string::npos && closed[0] != '>';
    EXPECT_EQ(Trackbed(folder, "report r -o page.html " + std::string(closed)).code,
              is_told ? 0 : 2)
        << closed;
    EXPECT_TRUE(ReadFile(folder.path() / "page.html") == page) << closed;
  }
}

TEST(Program, RefusesASecondWriterOfAFolder) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.path() / "r");
  for (const char* verb : {"run", "plan", "compare"}) {
    // flock(1) holds the lock as another process of trackbed would.
    const Outcome second = Shell(folder, std::string("flock r " TRACKBED_PROGRAM " ") + verb +
                                             " -o r " + ScenarioFile("winding"));
    EXPECT_EQ(second.code, 2) << verb;
    EXPECT_THAT(second.output,
                testing::MatchesRegex("r is being written by another trackbed( .process "
                                      "[0-9]+.)?\n"))
        << verb;
  }
}

TEST(Program, RefusesSeedsThatAreNone) {
  const TempFolder folder;
  EXPECT_EQ(Trackbed(folder, "check " + ScenarioFile("winding") + " --seed=-1").output,
            "--set: seed: expected a whole number from 0 to 18446744073709551615, found '-1'\n");
}

TEST(Program, FilmsARunWhoseModelIsGone) {
  const TempFolder folder;
  folder.Write("car.xml", ReadFile(std::string(TRACKBED_SOURCE_DIR) + "/models/prius/prius.xml"));
  folder.Write("s.yaml", ReadFile(ScenarioFile("winding")));
  Trackbed(folder, "run s.yaml -o r --set vehicle.model=./car.xml drive.time_limit=0.2");
  std::filesystem::remove(folder.path() / "car.xml");
  const Outcome film = Trackbed(folder, "render r --size 128x72 --fps 5 -o f.png");
  EXPECT_EQ(film.code, 0) << film.output;
}

TEST(Docs, CliPageHoldsWhatTheProgramSays) {
  const TempFolder folder;
  const std::string page = ReadFile(std::string(TRACKBED_SOURCE_DIR) + "/docs/cli.md");
  folder.Write("cli.md", page);
  const Outcome outcome = Trackbed(folder, "docs cli.md");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  std::istringstream told(ReadFile(folder.path() / "cli.md"));
  std::istringstream written(page);
  std::string told_line;
  std::string written_line;
  while (std::getline(told, told_line)) {
    std::getline(written, written_line);
    // Reports only the first line that differs.
    ASSERT_EQ(written_line, told_line)
        << "docs/cli.md is behind the program; run: build/release/trackbed docs docs/cli.md";
  }
  EXPECT_FALSE(std::getline(written, written_line)) << written_line;
}

TEST(Docs, PagesMustHaveAPlaceForEachTable) {
  const TempFolder folder;
  folder.Write("empty.md", "# Nothing\n");
  EXPECT_EQ(Trackbed(folder, "docs empty.md").output,
            "empty.md: no markers for 'verbs'; add the lines '<!-- begin: verbs -->' and '<!-- end "
            "-->' to the page\n");
  folder.Write("other.md", "<!-- begin: options of rum -->\n<!-- end -->\n");
  const Outcome other = Trackbed(folder, "docs other.md");
  EXPECT_EQ(other.code, 2);
  EXPECT_EQ(other.output,
            "other.md:1:1: unknown 'options of rum'; did you mean 'options of run'?\n");
  folder.Write("open.md", "<!-- begin: verbs -->\n# The rest\n");
  EXPECT_EQ(Trackbed(folder, "docs open.md").output,
            "open.md:1:1: no line '<!-- end -->' follows\n");
  EXPECT_EQ(ReadFile(folder.path() / "open.md"), "<!-- begin: verbs -->\n# The rest\n");
}

TEST(Program, TestsScenariosOneLineEach) {
  const TempFolder folder;
  const Outcome outcome =
      Trackbed(folder, "test --plant kinematic --set 'expect={reach_goal: 0.5}' -- " +
                           ScenarioFile("winding") + " " + ScenarioFile("three_turns"));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(Verdicts(outcome.output),
            "pass " + ScenarioFile("winding") + ": all expectations met\npass " +
                ScenarioFile("three_turns") + ": all expectations met\n2 scenarios: 2 passed\n");
  const Outcome failed =
      Trackbed(folder, "test -q --plant kinematic --set 'expect={max_cross_track: 0.001}' -- " +
                           ScenarioFile("winding"));
  EXPECT_EQ(failed.code, 3);
  EXPECT_THAT(
      WithoutDurations(failed.output),
      StartsWith("FAIL " + ScenarioFile("winding") + ": kinematic: maximum cross-track error "));
  EXPECT_THAT(failed.output, HasSubstr(" m exceeds 0.001 m at "));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST(Program, ChecksWithoutDriving) {
  const TempFolder folder;
  const auto bad = folder.Write("s/bad.yaml", "schema: 1\nname: bad\nmission: {}\n");
  folder.Write("s/good.yaml", ReadFile(ScenarioFile("winding")));
  const Outcome outcome = Trackbed(folder, "check s");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("s/bad.yaml:3:10: mission.speed: missing\n"));
  EXPECT_THAT(outcome.output, HasSubstr("s/good.yaml: ok\n"));
  std::filesystem::remove(bad);
  EXPECT_EQ(Trackbed(folder, "check s").code, 0);
  const Outcome camera = Trackbed(folder, "check s --set render.camera=chas");
  EXPECT_EQ(camera.code, 2);
  EXPECT_EQ(camera.output, "--set: render.camera: unknown 'chas'; did you mean 'chase'?\n");
  std::filesystem::create_directory(folder.path() / "empty");
  const Outcome empty = Trackbed(folder, "check empty s/good.yaml");
  EXPECT_EQ(empty.code, 2);
  EXPECT_EQ(empty.output, "empty: the folder has no scenarios (*.yaml, *.yml)\ns/good.yaml: ok\n");
  // Folders are searched recursively, for studies too.
  EXPECT_THAT(Trackbed(folder, "check " TRACKBED_SOURCE_DIR "/scenarios").output,
              testing::AllOf(HasSubstr("/scenarios/winding.yaml: ok\n"),
                             HasSubstr("/scenarios/maneuvers/gust.yaml: ok\n"),
                             HasSubstr("/scenarios/studies/validity.yaml: ok\n")));
}

TEST(Program, ChecksWhatIsExpectedOfMetrics) {
  const TempFolder folder;
  std::string text = ReadFile(ScenarioFile("winding"));
  text.insert(text.find("expect:") + 7, "\n  metrics: [{metric: steering_rat_max, max: 1}]");
  folder.Write("s.yaml", text);
  for (const char* verb : {"check", "run", "test", "compare"}) {
    const Outcome outcome = Trackbed(folder, std::string(verb) + " s.yaml");
    EXPECT_EQ(outcome.code, 2) << verb;
    EXPECT_THAT(outcome.output,
                StartsWith("s.yaml:12:22: expect.metrics[0].metric: unknown metric "
                           "'steering_rat_max'; did you mean 'steering_rate_max'?\n"))
        << verb;
  }
  EXPECT_THAT(folder.Names(), testing::ElementsAre("s.yaml"));  // nothing was driven
  // The number of turns is known only after planning.
  const Outcome turns = Trackbed(
      folder, "check " + ScenarioFile("winding") +
                  " --set 'expect.metrics=[{metric: \"turns[2].lateral_offset\", max: 1}]'");
  EXPECT_EQ(turns.code, 0) << turns.output;
}

TEST(Program, ListsWhatThereIs) {
  const TempFolder folder;
  const Outcome everything = Trackbed(folder, "list");
  EXPECT_EQ(everything.code, 0);
  for (const char* name :
       {"fillet", "preview", "mujoco", "single_track", "chase", "prius", "three_turns"}) {
    EXPECT_THAT(everything.output, HasSubstr(std::string("\n  ") + name + " "));
  }
  EXPECT_THAT(Trackbed(folder, "list controllers").output, HasSubstr("time: 0, law: exact_arc"));
  EXPECT_EQ(Trackbed(folder, "list controller").output,
            "cannot list 'controller'; did you mean 'controllers'?\n");
}

TEST(Program, ShowsAndSavesAModel) {
  const TempFolder folder;
  const Outcome shown = Trackbed(folder, "model prius");
  EXPECT_EQ(shown.code, 0);
  EXPECT_THAT(shown.output, HasSubstr("min_turning_radius                  5.1 m\n"));
  EXPECT_EQ(Trackbed(folder, "model prius --save car.xml").code, 0);
  // The saved model equals the original.
  EXPECT_THAT(Trackbed(folder, "model ./car.xml").output,
              HasSubstr("steering_rate                   0.15057 rad/s\n"));
  EXPECT_EQ(Trackbed(folder, "model pruis").output,
            "unknown model 'pruis'; did you mean 'prius'?\n");
}

TEST(Program, ShowsTheGgvDiagramOfAModel) {
  const TempFolder folder;
  const Outcome shown = Trackbed(folder, "model prius --ggv -o ggv.csv");
  EXPECT_EQ(shown.code, 0) << shown.output;
  EXPECT_THAT(shown.output, HasSubstr("g-g-v diagram of prius on a level road of factor 1"));
  EXPECT_THAT(shown.output, HasSubstr("\n      60 "));
  // Seven speeds, each from straight braking over the largest lateral acceleration to straight
  // acceleration.
  const Table table = ReadCsv(folder.path() / "ggv.csv");
  ASSERT_EQ(table.rows(), 7U * 49U);
  EXPECT_EQ(table.at(0, 1), 0.0);
  EXPECT_NEAR(table.at(0, 2), -8.26, 0.005);  // max_deceleration, to the digits of docs/models.md
  // Row 24 of each speed is at the largest lateral acceleration, which falls with the steering
  // angle of slow turns.
  EXPECT_GT(table.at(6 * 49 + 24, 1), 8.0);
  EXPECT_LT(table.at(24, 1), table.at(6 * 49 + 24, 1));
  EXPECT_EQ(Trackbed(folder, "model prius -o ggv.csv").output, "--out: needs --ggv or --adapt\n");
}

/// Runs the program and sends it a signal as soon as the shell condition `there` holds, after a
/// minute at the latest.
Outcome Interrupted(const TempFolder& folder, const std::string& arguments,
                    const std::string& there, const std::string& signal) {
  return Trackbed(folder, arguments + " & n=0; until " + there +
                              " || [ $n -gt 600 ]; do n=$((n + 1)); sleep 0.1; done; kill -" +
                              signal + " $!; wait $!");
}

TEST(Program, CtrlCKeepsTheLogSoFar) {
  for (const char* signal : {"INT", "TERM", "HUP"}) {
    const TempFolder folder;
    // The output folder appears before the run begins.
    const Outcome outcome =
        Interrupted(folder,
                    "run " + ScenarioFile("three_turns") + " " + ScenarioFile("winding") +
                        " -o r --set drive.timestep=0.0001",
                    "[ -d r/three_turns ]", signal);
    EXPECT_EQ(outcome.code, 130) << signal;
    EXPECT_THAT(outcome.output, HasSubstr("three_turns: interrupted, in r/three_turns\n"));
    EXPECT_THAT(outcome.output, HasSubstr("interrupted: 1 of 2 scenarios not run\n"));
    EXPECT_THAT(ReadFile(folder.path() / "r/three_turns/metrics.json"),
                HasSubstr("\"complete\": false"));
  }
}

TEST(Program, CtrlCInTheFilmLeavesTheVerdict) {
  const TempFolder folder;
  if (!HasVideo(folder)) {
    GTEST_SKIP() << "built without video";
  }
  // The verdict is printed before the film, which would take many seconds.
  const Outcome outcome = Interrupted(folder,
                                      "run --video --plant kinematic -o r --set 'expect={}' -- " +
                                          ScenarioFile("winding") + " " +
                                          ScenarioFile("three_turns") + " >told 2>errors",
                                      "[ -s told ]", "INT");
  EXPECT_EQ(outcome.code, 130);
  EXPECT_THAT(ReadFile(folder.path() / "told"), StartsWith("winding: passed, in r/winding\n"));
  // On a busy machine a frame may take longer than the time that the program has to end.
  EXPECT_THAT(ReadFile(folder.path() / "errors"),
              AnyOf("interrupted; no film was written\ninterrupted: 1 of 2 scenarios not run\n",
                    "interrupted: ended in the middle of its work\n"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "r/winding/video.mp4"));
}

}  // namespace
}  // namespace trackbed
