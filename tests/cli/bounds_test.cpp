#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/processor_time.h"
#include "tests/support/wrong_number.h"
#include "trackbed/core/file.h"

// Tests bounds of time and memory, with input files that are not regular, paths and numbers that
// are too large, and signals in the middle of long work.
namespace trackbed {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Eq;
using ::testing::HasSubstr;
using ::testing::Not;

// --- pipes ---------------------------------------------------------------------------------------

std::string ScenarioText(const std::string& rest) {
  return "schema: 1\nname: a\nvehicle: {model: prius}\n" + rest;
}

/// Scenarios that name the pipe `p` with some ending, one for each kind of input.
std::vector<std::pair<std::string, std::string>> ScenariosThatNamePipes() {
  const std::string route = "mission: {speed: 3, waypoints: [[0, 0], [60, 0]]}\n";
  const std::string astar = "plan: {method: astar}\n";
  return {
      {"path.csv",
       ScenarioText("mission: {speed: 3}\nplan: {method: path_file, file: path.csv}\n")},
      {"path.json",
       ScenarioText("mission: {speed: 3}\nplan: {method: path_file, file: path.json}\n")},
      {"path.xml",
       ScenarioText("mission: {speed: 3}\nplan: {method: path_file, file: path.xml}\n")},
      {"track.csv",
       ScenarioText(
           "mission: {speed: 3, track: {file: track.csv}}\nplan: {method: center_line}\n")},
      {"map.yaml", ScenarioText(route + astar + "world: {map: {file: map.yaml}}\n")},
      {"map.map", ScenarioText(route + astar + "world: {map: {file: map.map, cell: 1}}\n")},
      {"image.pgm", ScenarioText(route + astar + "world: {map: {file: ros.yaml}}\n")},
      {"roads.xodr",
       ScenarioText("mission: {speed: 3, route: [{road: a, lane: 1, s: 0}]}\n"
                    "plan: {method: lane_route}\nworld: {road_network: roads.xodr}\n")},
      {"record.csv", ScenarioText("record: {file: record.csv}\ndrive: {plants: [recorded]}\n")},
      {"log_map.yaml", ScenarioText("record: {file: log.csv, map: log_map.yaml}\n"
                                    "drive: {plants: [recorded]}\n")},
      {"playback.csv", ScenarioText(route + "control: {method: playback, file: playback.csv}\n")},
      {"model.xml", "schema: 1\nname: a\nvehicle: {model: model.xml}\n" + route + astar},
  };
}

TEST(InputPipe, NamedByAScenarioIsRefused) {
  for (const auto& [name, scenario] : ScenariosThatNamePipes()) {
    SCOPED_TRACE(name);
    const TempFolder folder;
    folder.Write("s.yaml", scenario);
    folder.Write("ros.yaml",
                 "image: image.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n"
                 "occupied_thresh: 0.65\nfree_thresh: 0.2\n");
    folder.Write("log.csv", "t\n0\n");
    const Outcome outcome =
        Shell(folder, "mkfifo " + name + "; timeout 20 " TRACKBED_PROGRAM " check s.yaml");
    EXPECT_EQ(outcome.code, 2) << outcome.output;
    EXPECT_THAT(outcome.output,
                AllOf(HasSubstr(name + ": it is a pipe"), Not(HasSubstr("internal error"))));
  }
}

TEST(InputPipe, OfACommandLineIsRefused) {
  const TempFolder folder;
  folder.Write("log.csv", "t\n0\n");
  const std::string log_map =
      (fs::path(TRACKBED_SOURCE_DIR) / "scenarios/real/maps/trackbed.yaml").string();
  for (const std::string& arguments : std::vector<std::string>{"check p",
                                                               "run p",
                                                               "plan p",
                                                               "fmu p -o car.fmu",
                                                               "test p",
                                                               "check-path p --speed 3",
                                                               "sweep p",
                                                               "falsify p",
                                                               "verify p",
                                                               "identify p",
                                                               "import p --map " + log_map,
                                                               "import log.csv --map p",
                                                               "model ./p",
                                                               "model ./p --adapt",
                                                               "report p",
                                                               "render p",
                                                               "compare p",
                                                               "compare p p",
                                                               "watch p",
                                                               "check /dev/stdin",
                                                               "check /dev/zero",
                                                               "check-path /dev/zero --speed 3"}) {
    // No process writes to the pipe, which is also standard input.
    const Outcome outcome = Shell(
        folder, "[ -p p ] || mkfifo p; timeout 15 " TRACKBED_PROGRAM " " + arguments + " 0<>p");
    EXPECT_EQ(outcome.code, 2) << arguments << ": " << outcome.output;
  }
  // bash's process substitution is a pipe.
  const Outcome substituted =
      Shell(folder, "timeout 15 bash -c '" TRACKBED_PROGRAM
                    " check-path --speed 3 <(printf \"x_m,y_m\\n0,0\\n9,0\\n\")'");
  EXPECT_EQ(substituted.code, 2);
  EXPECT_THAT(substituted.output, HasSubstr("it is a pipe; must be a regular file"));
}

// --- lengths and numbers -------------------------------------------------------------------------

/// Runs the program with 1.5 GB of address space, including its libraries, and 20 s. Sanitizers get
/// more.
Outcome Bounded(const TempFolder& folder, const std::string& arguments) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  // Sanitizers reserve terabytes of address space and are several times slower.
  return Shell(folder, "timeout 200 " TRACKBED_PROGRAM " " + arguments);
#else
  return Shell(folder, "ulimit -v 1500000; timeout 20 " TRACKBED_PROGRAM " " + arguments);
#endif
}

TEST(LongPath, IsRefusedWithItsRows) {
  const TempFolder folder;
  folder.Write("p.csv", "x_m,y_m\n0,0\n1e6,0\n");
  const Outcome refused = Bounded(folder, "check-path p.csv --speed 8");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.output, HasSubstr("p.csv:3: the path is 1000000 m long; must be at most "
                                        "200000 m: the gap between rows 2 and 3 is 1000000 m"));
  folder.Write("p.geojson",
               R"({"type": "LineString", "coordinates": [[9, 50], [9, 52], [9, 53]]})");
  EXPECT_THAT(Bounded(folder, "check-path p.geojson --speed 8").output,
              HasSubstr("p.geojson: the path is "));
}

TEST(LongPath, OfTwoHundredKilometersIsChecked) {
  const TempFolder folder;
  std::string csv = "x_m,y_m\n";
  for (int i = 0; i <= 2000; ++i) {
    csv += std::to_string(99.0 * i) + "," + std::to_string(300.0 * std::sin(i / 30.0)) + "\n";
  }
  folder.Write("p.csv", csv);
  for (const char* fit : {"spline", "polyline"}) {
    const Outcome checked = Bounded(
        folder, std::string("check-path p.csv --speed 8 --report p.html --json --fit ") + fit);
    EXPECT_THAT(checked.code, AnyOf(Eq(0), Eq(3))) << checked.output.substr(0, 300);
  }
}

TEST(LongRoute, IsRefusedWithItsLeg) {
  const TempFolder folder;
  folder.Write("s.yaml",
               ScenarioText("mission: {speed: 3, waypoints: [[0, 0], [90000, 0], [-90000, 0]]}\n"
                            "plan: {method: dubins}\n"));
  const Outcome refused = Bounded(folder, "check s.yaml");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(
      refused.output,
      HasSubstr("mission.waypoints[2]: the route is 270000 m long; must be at most 200000 m: "
                "the leg to this waypoint is 180000 m"));
}

TEST(LongRoute, OfManyWaypointsIsRefused) {
  const TempFolder folder;
  std::string points = "[0, 0]";
  for (int i = 1; i <= 5000; ++i) {
    points += fmt::format(", [{}, {}]", 20 * i, i % 2);
  }
  folder.Write("s.yaml", ScenarioText("mission: {speed: 3, waypoints: [" + points +
                                      "]}\nplan: {method: dubins}\n"));
  const Outcome refused = Bounded(folder, "check s.yaml");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.output,
              HasSubstr("mission.waypoints: 5001 given; must be at most 5000: give a recorded path "
                        "to plan: {method: path_file}, or divide the route"));
}

TEST(LongCourse, IsRefusedWithItsLongestSegment) {
  const TempFolder folder;
  folder.Write("s.yaml",
               ScenarioText("mission: {speed: 3}\nplan: {method: course, segments: [{length: 9e5, "
                            "curvature: 0}, {length: 1e6, curvature: 0.1}]}\n"));
  const Outcome refused = Bounded(folder, "check s.yaml");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.output,
              HasSubstr("plan.segments[1].length: the course is 1900000 m long; must be at most "
                        "200000 m: this segment, the longest one, is 1000000 m"));
}

// A ramp of 15 km that turns by 750 rad has 7000 times the turn of a usual one, and must not take
// that many times the time.
TEST(LongCourse, OfARampWithManyTurnsIsPlanned) {
  const TempFolder folder;
  folder.Write("s.yaml",
               ScenarioText("mission: {speed: 3}\nplan: {method: course, segments: [{length: "
                            "15000, curvature_to: 0.1}]}\n"));
  const double begun = ProcessorTime();
  const Outcome planned = Bounded(folder, "plan s.yaml -q -o out");
  EXPECT_EQ(planned.code, 0) << planned.output;
  EXPECT_LE(ProcessorTime() - begun, 5.0);
}

TEST(LongRun, IsRefusedWithItsRows) {
  const TempFolder folder;
  const Outcome refused = Trackbed(folder, "check three_turns --set drive.time_limit=50000");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.output,
              HasSubstr("drive.time_limit: 50000 s with a row every 0.02 s are 2500000 rows of a "
                        "log; must be at most 2000000: shorten it, or lengthen "
                        "drive.control_period"));
}

/// Checks files with one wrong number. The program must print a result or a problem in the file,
/// within the bounds of time and memory.
void TrySlips(const TempFolder& folder, const std::string& name, std::size_t from, int count) {
  const std::string text = ReadFile(folder.path() / name);
  std::mt19937_64 random(7);
  for (int i = 0; i < count; ++i) {
    folder.Write(name, WithWrongNumber(text, from, random));
    const double begun = ProcessorTime();
    const Outcome outcome = Bounded(folder, "check s.yaml");
    EXPECT_THAT(outcome.code, AnyOf(Eq(0), Eq(2))) << name << ", slip " << i << outcome.output;
    EXPECT_LE(ProcessorTime() - begun, 5.0);
    EXPECT_THAT(outcome.output, Not(HasSubstr("internal error")));
  }
  folder.Write(name, text);
}

TEST(WrongNumber, OfAMapEndsInTime) {
  const TempFolder folder;
  const fs::path maps = fs::path(TRACKBED_SOURCE_DIR) / "scenarios/maps";
  fs::copy(maps / "hall.yaml", folder.path() / "hall.yaml");
  fs::copy(maps / "hall.pgm", folder.path() / "hall.pgm");
  folder.Write("s.yaml", ScenarioText("mission: {speed: 3, waypoints: [[0, 0], [10, 0]]}\n"
                                      "plan: {method: astar}\nworld: {map: {file: hall.yaml}}\n"));
  TrySlips(folder, "hall.yaml", 0, 20);
  fs::copy(maps / "old_town.map", folder.path() / "old_town.map");
  folder.Write(
      "s.yaml",
      ScenarioText("mission: {speed: 3, waypoints: [[0, 0], [10, 0]]}\nplan: {method: astar}\n"
                   "world: {map: {file: old_town.map, cell: 0.5}}\n"));
  TrySlips(folder, "old_town.map", 0, 8);
  TrySlips(folder, "s.yaml", 10, 30);
}

TEST(WrongNumber, OfRoadsEndsInTime) {
  const TempFolder folder;
  const fs::path roads = fs::path(TRACKBED_SOURCE_DIR) / "scenarios/roads";
  fs::copy(roads / "crossing.xodr", folder.path() / "crossing.xodr");
  fs::copy(roads / "crossing.yaml", folder.path() / "s.yaml");
  TrySlips(folder, "crossing.xodr", 60, 40);
  TrySlips(folder, "s.yaml", 0, 20);
}

// --- signals -------------------------------------------------------------------------------------

/// Sends a signal to the program as soon as the shell command `wait` ends. Returns the outcome, and
/// the time from the signal to the end [s].
std::pair<Outcome, double> Ended(const TempFolder& folder, const std::string& arguments,
                                 const std::string& signal, const std::string& wait = "sleep 1") {
  const Outcome outcome = Shell(
      folder, TRACKBED_PROGRAM " " + arguments + " > said 2>&1 & " + wait +
                  "; kill -0 $! || { echo ended before; exit 9; }; "
                  "begun=$(date +%s%N); kill -" +
                  signal + " $!; wait $!; code=$?; echo $(( $(date +%s%N) - begun )); exit $code");
  return {outcome, outcome.code == 9 ? 0.0 : 1e-9 * std::stod(outcome.output)};
}

/// A scenario whose planner draws two million samples without finding a path.
std::string VainSearch() {
  return ScenarioText(
      "mission: {speed: 3, waypoints: [[0, 0], [80, 0]]}\n"
      "world: {obstacles: [{box: {x: 70, y: 0, length: 1, width: 60}}, "
      "{box: {x: 90, y: 0, length: 1, width: 60}}, {box: {x: 80, y: 30, length: 21, width: 1}}, "
      "{box: {x: 80, y: -30, length: 21, width: 1}}]}\n"
      "plan: {method: rrt_star, trees: 1000, iterations: 1000000}\n");
}

class SignalTo : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Verbs, SignalTo,
                         ::testing::Values("plan vain.yaml", "run vain.yaml", "compare vain.yaml",
                                           "test vain.yaml", "sweep study.yaml -j 1",
                                           "watch vain.yaml", "identify identify_mujoco.yaml",
                                           "run three_turns --set drive.timestep=0.0001"),
                         [](const auto& of) {
                           return of.param.substr(0, of.param.find(' ')) + std::to_string(of.index);
                         });

TEST_P(SignalTo, EndsItWithinASecond) {
  const TempFolder folder;
  folder.Write("vain.yaml", VainSearch());
  folder.Write("study.yaml",
               "schema: 1\nname: study\nscenario: vain.yaml\nvary: {mission.speed: [2, 3, 4]}\n");
  std::string arguments = GetParam();
  if (const std::size_t file = arguments.find("identify_mujoco"); file != std::string::npos) {
    arguments.insert(file, std::string(TRACKBED_SOURCE_DIR) + "/scenarios/real/");
  }
  for (const char* signal : {"TERM", "INT", "HUP"}) {
    const auto [outcome, seconds] = Ended(folder, arguments, signal);
    EXPECT_EQ(outcome.code, 130) << signal << ": " << ReadFile(folder.path() / "said");
    // The program ends within 0.7 s. The bound allows for a busy machine.
    EXPECT_LE(seconds, 1.5) << signal;
  }
}

TEST(Signal, LeavesTheLogOfARunWithoutMcap) {
  const TempFolder folder;
  // The run creates its folder before the simulation.
  const auto ended =
      Ended(folder, "run three_turns -o r --mcap --plant mujoco --set drive.timestep=0.0001",
            "TERM", "until [ -d r ]; do kill -0 $! && sleep 0.1 || break; done; sleep 1");
  EXPECT_EQ(ended.first.code, 130);
  EXPECT_TRUE(fs::exists(folder.path() / "r/mujoco.csv"));
  EXPECT_FALSE(fs::exists(folder.path() / "r/run.mcap"));
}

TEST(Signal, InTheMiddleOfPlanningLeavesTheEarlierResult) {
  const TempFolder folder;
  folder.Write("vain.yaml", VainSearch());
  ASSERT_EQ(Trackbed(folder, "run three_turns -o r --plant kinematic -q").code, 0);
  const std::string before = ReadFile(folder.path() / "r/manifest.json");
  EXPECT_EQ(Ended(folder, "run vain.yaml -o r", "TERM").first.code, 130);
  EXPECT_EQ(ReadFile(folder.path() / "said"), "interrupted: ended in the middle of its work\n");
  EXPECT_EQ(ReadFile(folder.path() / "r/manifest.json"), before);
  EXPECT_EQ(Trackbed(folder, "report r -o page.html").code, 0);
}

/// A film whose first frame takes about as long as the program has to end after a signal.
class SignalToFilm : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Kinds, SignalToFilm, ::testing::Values("mp4", "png", "webp"),
                         [](const auto& of) { return of.param; });

TEST_P(SignalToFilm, LeavesNoTemporaryFile) {
  const TempFolder folder;
  ASSERT_EQ(Trackbed(folder, "run three_turns -o r --plant kinematic -q").code, 0);
  const Outcome outcome =
      Ended(folder, "render r -o film." + GetParam() + " --size 3840x2160", "TERM",
            "until ls -A | grep -q '^[.]film'; do kill -0 $! && sleep 0.05 || break; done")
          .first;
  EXPECT_EQ(outcome.code, 130) << ReadFile(folder.path() / "said");
  EXPECT_EQ(Shell(folder, "ls -A | grep '^[.]'").output, "");
}

}  // namespace
}  // namespace trackbed
