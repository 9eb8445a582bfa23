#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/support/temp_folder.h"
#include "trackbed/control/preview.h"
#include "trackbed/core/error.h"
#include "trackbed/scenario/keys.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/scenario/study_check.h"
#include "trackbed/scenario/study_reader.h"

namespace trackbed {
namespace {

constexpr const char* kScenario = R"(schema: 1
name: small
mission:
  speed: 3
  waypoints: [[0, 0], [40, 0], [40, 40]]
plan: {method: fillet}
control: {method: preview}
)";

const std::string kHead = "schema: 1\nname: study\nscenario: small.yaml\n";

/// A folder with the scenario and a study of it.
class StudyFiles : public testing::Test {
 protected:
  StudyFiles() { folder_.Write("small.yaml", kScenario); }

  [[nodiscard]] Study Read(const std::string& keys,
                           const std::vector<Override>& overrides = {}) const {
    return ReadStudy(folder_.Write("study.yaml", kHead + keys), overrides);
  }

  /// Returns the error messages of a study and its points, without the folder.
  [[nodiscard]] std::string ErrorMessages(const std::string& keys,
                                          const std::vector<Override>& overrides = {}) const {
    return ErrorsOfText(kHead + keys, overrides);
  }

  [[nodiscard]] std::string ErrorsOfText(const std::string& text,
                                         const std::vector<Override>& overrides = {}) const {
    std::string message = "no error";
    try {
      CheckPoints(StudyPoints(ReadStudy(folder_.Write("study.yaml", text), overrides)), true);
    } catch (const InputError& error) {
      message = error.what();
    }
    const std::string folder = folder_.path().string() + "/";
    for (std::size_t at = 0; (at = message.find(folder)) != std::string::npos;) {
      message.erase(at, folder.size());
    }
    return message;
  }

  TempFolder folder_;
};

TEST_F(StudyFiles, NameAMisspelledKeyBesideASettingThatNeedsIt) {
  // The element [0] exists only if the key `gusts` of `set` has the right name.
  EXPECT_EQ(ErrorMessages("set:\n  world.wind: {gustss: [{from: 1, y: 5, duration: 1}]}\n"
                          "vary:\n  world.wind.gusts[0].y: [3, 4]\n"),
            "study.yaml:5:15: world.wind.gustss: unknown key 'gustss'; did you mean 'gusts'?\n"
            "study.yaml:7:27: world.wind.gusts[0].y: element [0] does not exist");
}

/// "key=value key=value" of each point.
std::vector<std::string> Written(const StudyPoints& points) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::string& text = texts.emplace_back();
    for (const Setting& setting : points.Settings(i)) {
      text += (text.empty() ? "" : " ") + setting.key + "=" + setting.value;
    }
  }
  return texts;
}

using Grid = StudyFiles;

TEST_F(Grid, IsEveryCombinationWithTheLastKeyFastest) {
  EXPECT_THAT(Written(StudyPoints(Read("vary: {mission.speed: [3, 2.5], seed: [1, 2, 7]}\n"))),
              testing::ElementsAre("mission.speed=3 seed=1", "mission.speed=3 seed=2",
                                   "mission.speed=3 seed=7", "mission.speed=2.5 seed=1",
                                   "mission.speed=2.5 seed=2", "mission.speed=2.5 seed=7"));
}

TEST_F(Grid, TakesPointsOfAListAtEachOfItsOwn) {
  EXPECT_THAT(Written(StudyPoints(Read(R"(vary: {mission.speed: [3, 2]}
list:
  - {control.method: preview, control.distance: 4}
  - {control.method: schedule}
)"))),
              testing::ElementsAre("mission.speed=3 control.method=preview control.distance=4",
                                   "mission.speed=3 control.method=schedule",
                                   "mission.speed=2 control.method=preview control.distance=4",
                                   "mission.speed=2 control.method=schedule"));
  EXPECT_THAT(Written(StudyPoints(Read("list: [{seed: 4}, {seed: 3}]\n"))),
              testing::ElementsAre("seed=4", "seed=3"));
}

TEST_F(Grid, IsOnePointWhereNothingVaries) {
  EXPECT_THAT(Written(StudyPoints(Read("repeat: 5\n"))), testing::ElementsAre(""));
}

TEST_F(Grid, DividesARangeEvenlyAndEndsOnItsEnds) {
  EXPECT_THAT(
      Written(StudyPoints(Read("vary: {world.friction: {from: 0.2, to: 1.0, steps: 5}}\n"))),
      testing::ElementsAre("world.friction=0.2", "world.friction=0.4", "world.friction=0.6",
                           "world.friction=0.8", "world.friction=1"));
  EXPECT_THAT(Written(StudyPoints(Read("vary: {mission.speed: {from: 0.1, to: 0.3, steps: 3}}\n"))),
              testing::ElementsAre("mission.speed=0.1", "mission.speed=0.2", "mission.speed=0.3"));
  EXPECT_THAT(Written(StudyPoints(
                  Read("vary: {control.distance: {from: 0.1, to: 100, steps: 4, scale: log}}"))),
              testing::ElementsAre("control.distance=0.1", "control.distance=1",
                                   "control.distance=10", "control.distance=100"));
}

TEST_F(Grid, KeepsValuesAsTheyWereWritten) {
  EXPECT_THAT(
      Written(StudyPoints(Read(R"(vary:
  drive.plants: [[kinematic], [kinematic, "mujoco"]]
  mission.start: [{x: 1, yaw: -0.5}]
  vehicle.model: [prius, 'pri: us', "2"]
)"))),
      testing::ElementsAre(
          R"(drive.plants=[kinematic] mission.start={x: 1, yaw: -0.5} vehicle.model=prius)",
          R"(drive.plants=[kinematic] mission.start={x: 1, yaw: -0.5} vehicle.model="pri: us")",
          R"(drive.plants=[kinematic] mission.start={x: 1, yaw: -0.5} vehicle.model="2")",
          R"(drive.plants=[kinematic, "mujoco"] mission.start={x: 1, yaw: -0.5} vehicle.model=prius)",
          R"(drive.plants=[kinematic, "mujoco"] mission.start={x: 1, yaw: -0.5} vehicle.model="pri: us")",
          R"(drive.plants=[kinematic, "mujoco"] mission.start={x: 1, yaw: -0.5} vehicle.model="2")"));
}

TEST_F(Grid, LeavesOutKeysWhoseConditionDoesNotHold) {
  EXPECT_THAT(Written(StudyPoints(Read(R"(vary:
  control.method: [preview, schedule]
  control.distance: {values: [2, 4], when: {control.method: preview}}
  mission.speed: [1, 3]
)"))),
              testing::ElementsAre("control.method=preview control.distance=2 mission.speed=1",
                                   "control.method=preview control.distance=2 mission.speed=3",
                                   "control.method=preview control.distance=4 mission.speed=1",
                                   "control.method=preview control.distance=4 mission.speed=3",
                                   "control.method=schedule mission.speed=1",
                                   "control.method=schedule mission.speed=3"));
  // `when` may list several values, may belong to a grid, and may name keys that `set` defines.
  EXPECT_THAT(
      Written(StudyPoints(Read(R"(set: {drive.timestep: 0.002}
vary:
  mission.speed: [1, 2, 3.0]
  seed: {from: 1, to: 2, steps: 2, when: {mission.speed: [1.0, 3], drive.timestep: 0.002}}
)"))),
      testing::ElementsAre("mission.speed=1 seed=1", "mission.speed=1 seed=2", "mission.speed=2",
                           "mission.speed=3.0 seed=1", "mission.speed=3.0 seed=2"));
}

TEST_F(Grid, RefusesConditionsOfWhatIsNotSetBefore) {
  EXPECT_EQ(ErrorMessages(R"(vary:
  seed: {values: [2, 4], when: {mision.speed: 1}}
  mission.speed: [1, 2]
)"),
            "study.yaml:5:19: vary.seed.when: a key that the study does not set before: "
            "'mision.speed'; allowed: ");
  EXPECT_EQ(ErrorMessages(R"(sample: {count: 2}
vary:
  mission.speed: {distribution: uniform, from: 1, to: 2}
  seed: {values: [2, 4], when: {mission.speed: 1}}
)"),
            "study.yaml:7:19: vary.seed.when: mission.speed is sampled, so that a key of the grid "
            "cannot depend on it");
}

using Sampled = StudyFiles;

TEST_F(Sampled, MeetTheSameSampleAtEachPointOfTheGrid) {
  const StudyPoints points(Read(R"(sample: {count: 3, method: sobol, seed: 4}
vary:
  world.friction: {distribution: uniform, from: 0.2, to: 1}
  control.method: [preview, schedule]
  disturb.payload.mass: {distribution: normal, mean: 100, deviation: 30, min: 0}
)"));
  ASSERT_EQ(points.size(), 6U);
  const auto sample = [&](std::size_t i) {
    const std::vector<Setting> settings = points.Settings(i);
    return settings.at(1).key + "=" + settings.at(1).value + " " + settings.at(2).key + "=" +
           settings.at(2).value;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(points.Settings(i).at(0).value, "preview");
    EXPECT_EQ(points.Settings(3 + i).at(0).value, "schedule");
    EXPECT_EQ(sample(i), sample(3 + i));
  }
  EXPECT_NE(sample(0), sample(1));
  EXPECT_THAT(sample(0), testing::StartsWith("world.friction="));
  const Scenario scenario = points.Read(1).scenario;
  EXPECT_GE(scenario.world.friction, 0.2);
  EXPECT_LE(scenario.world.friction, 1.0);
}

TEST_F(Sampled, TakeKeysOfOneFileFromOneRow) {
  folder_.Write("roads.csv", "mu,speed\n0.3,1\n0.5,2\n0.7,3\n");
  const StudyPoints points(Read(R"(sample: {count: 9}
vary:
  world.friction: {distribution: file, file: roads.csv, column: mu}
  mission.speed: {distribution: file, file: roads.csv, column: speed}
)"));
  std::multiset<std::string> seen;
  for (const std::string& point : Written(points)) {
    seen.insert(point);
  }
  // A Latin hypercube of nine points has three points in each third of a key's range.
  EXPECT_EQ(seen, (std::multiset<std::string>{
                      "world.friction=0.3 mission.speed=1", "world.friction=0.3 mission.speed=1",
                      "world.friction=0.3 mission.speed=1", "world.friction=0.5 mission.speed=2",
                      "world.friction=0.5 mission.speed=2", "world.friction=0.5 mission.speed=2",
                      "world.friction=0.7 mission.speed=3", "world.friction=0.7 mission.speed=3",
                      "world.friction=0.7 mission.speed=3"}));
}

TEST_F(Sampled, KeepRowsOfAnOutput) {
  const auto keep = [&](const std::string& text) {
    return ToString(
        Read("vary: {seed: [1]}\noutputs: [verdict.passed, plan.length_m]\nkeep: " + text + "\n")
            .keep);
  };
  EXPECT_EQ(keep("none"), "none");
  EXPECT_EQ(keep("failed"), "failed");
  EXPECT_EQ(keep("all"), "all");
  EXPECT_EQ(keep("worst 10 by plan.length_m"), "worst 10 by plan.length_m");
  EXPECT_EQ(keep("lowest 1 by plan.length_m"), "lowest 1 by plan.length_m");
  const auto refusal = [&](const std::string& text, const std::string& keys = "") {
    return ErrorMessages("vary: {seed: [1]}\noutputs: [plan.length_m]\nkeep: " + text + "\n" +
                         keys);
  };
  EXPECT_EQ(refusal("worst"),
            "study.yaml:6:7: keep: 'worst' is not understood; give none, failed, all, worst N by "
            "OUTPUT or lowest N by OUTPUT");
  EXPECT_EQ(refusal("worst 10 by plan.length_m, please").substr(0, 64),
            "study.yaml:6:7: keep: 'worst 10 by plan.length_m, please' is not");
  EXPECT_EQ(refusal("worst 0 by plan.length_m"),
            "study.yaml:6:7: keep: 0 rows; must be from 1 to 1000");
  EXPECT_EQ(refusal("worst 3 by plan.lenght_m"),
            "study.yaml:6:7: keep: no output 'plan.lenght_m'; did you mean 'plan.length_m'?");
  EXPECT_EQ(ErrorMessages("vary: {seed: [1]}\nkeep: worst 3 by x\n"),
            "study.yaml:5:7: keep: 'x' must be one of the study's outputs, and it has none");
  EXPECT_EQ(refusal("failed", "bisect: {key: mission.speed, from: 1, to: 2, tolerance: 0.1}\n"),
            "study.yaml:6:7: keep: a row of a bisection has many runs; give none, or leave out "
            "bisect");
}

TEST_F(Sampled, SayWhatIsWrong) {
  EXPECT_EQ(ErrorMessages("vary: {seed: {distribution: uniform, from: 1, to: 2}}\n"),
            "study.yaml:4:7: sample: missing; keys of vary have distributions");
  EXPECT_EQ(ErrorMessages("sample: {count: 4}\nvary: {seed: [1]}\n"),
            "study.yaml:4:9: sample: no key of vary has a distribution");
  EXPECT_EQ(ErrorMessages("sample: {count: 4}\nvary: {seed: {distribution: unifrom, from: 1, to: "
                          "2}}\n"),
            "study.yaml:5:29: vary.seed.distribution: unknown 'unifrom'; did you mean "
            "'uniform'?");
  EXPECT_EQ(ErrorMessages("sample: {count: 4}\n"
                          "vary: {seed: {distribution: integer, from: 1.5, to: 2}}\n"),
            "study.yaml:5:44: vary.seed.from: 1.5 is no whole number");
  EXPECT_EQ(ErrorMessages("sample: {count: 4}\n"
                          "vary: {seed: {distribution: choice, values: [1, 2], weights: [1]}}\n"),
            "study.yaml:5:62: vary.seed.weights: 1 weights of 2 values");
  EXPECT_EQ(ErrorMessages("sample: {count: 4}\n"
                          "vary: {seed: {distribution: uniform, from: 1, to: 2, mean: 3}}\n"),
            "study.yaml:5:54: vary.seed.mean: unknown key 'mean'; allowed: distribution, from, to, "
            "step, when");
  EXPECT_THAT(ErrorMessages("sample: {count: 4}\n"
                            "vary: {seed: {distribution: file, file: /etc/passwd, column: x}}\n"),
              testing::HasSubstr("vary.seed.file: /etc/passwd is an absolute path"));
}

using Derived = StudyFiles;

TEST_F(Derived, FollowFromTheKeysOfThePoint) {
  EXPECT_THAT(Written(StudyPoints(Read(R"(set: {world.friction: 0.5}
vary: {mission.speed: [2, 4]}
derive:
  control.distance: 1.5 * mission.speed
  drive.time_limit: control.distance + sqrt(world.friction * 2)
)"))),
              testing::ElementsAre("mission.speed=2 control.distance=3 drive.time_limit=4",
                                   "mission.speed=4 control.distance=6 drive.time_limit=7"));
}

TEST_F(Derived, SayWhatIsWrong) {
  EXPECT_THAT(ErrorMessages("vary: {mission.speed: [2]}\nderive: {seed: mission.sped + 1}\n"),
              testing::HasSubstr("derive.seed: uses a key that the study does not set before: "
                                 "'mission.sped'; did you mean 'mission.speed'?"));
  EXPECT_THAT(ErrorMessages("vary: {mission.speed: [2]}\nderive: {seed: mission.speed + }\n"),
              testing::HasSubstr("derive.seed: 'mission.speed +' is no formula: "));
  for (const auto& [formula, values] : {std::pair("mission.speed, 3", 2),
                                        {"3, mission.speed", 2},
                                        {"1, 2, 3", 3},
                                        {"max(1, 2), mission.speed", 2}}) {
    EXPECT_THAT(ErrorMessages("vary: {mission.speed: [2]}\nderive: {seed: \"" +
                              std::string(formula) + "\"}\n"),
                testing::HasSubstr(fmt::format("derive.seed: '{}' is no formula: {} values with "
                                               "commas between them; must be one",
                                               formula, values)));
  }
  EXPECT_THAT(ErrorMessages("vary: {mission.speed: [2]}\nderive: {seed: mission.speed = 3}\n"),
              testing::HasSubstr("derive.seed: 'mission.speed = 3' is no formula: "));
  EXPECT_THAT(
      ErrorMessages("vary: {mission.speed: [2]}\nderive: {seed: 1 / (mission.speed - 2)}\n"),
      testing::HasSubstr("derive.seed: '1 / (mission.speed - 2)' is inf here"));
  EXPECT_THAT(ErrorMessages("vary: {drive.plants: [[kinematic]]}\nderive: {seed: drive.plants}\n"),
              testing::HasSubstr("drive.plants is [kinematic], not a number"));
}

using Points = StudyFiles;

TEST_F(Points, AreTheScenarioWithWhatTheStudySets) {
  const StudyPoints points(Read(R"(set: {drive.plants: [kinematic], mission.speed: 2}
vary: {control.distance: [3, 4]}
)"));
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points.Read(1).scenario.mission.speed, 2.0);
  EXPECT_EQ(points.Read(1).scenario.drive.plants, std::vector<std::string>{"kinematic"});
  EXPECT_EQ(points.Read(0).scenario.control.steering.Get<PreviewOptions>().distance, 3.0);
  EXPECT_EQ(points.Read(1).scenario.control.steering.Get<PreviewOptions>().distance, 4.0);
  EXPECT_EQ(Written(points)[1], "control.distance=4");
}

TEST_F(Points, TakeWhatTheCommandLineSetsInPlaceOfTheStudysOwn) {
  const StudyPoints points(
      Read("set: {mission.speed: 2}\nvary: {control.distance: [3]}\n", {"mission.speed=1.5"}));
  EXPECT_EQ(points.Read(0).scenario.mission.speed, 1.5);
  EXPECT_EQ(ErrorMessages("set: {mission.speed: 2}\nrepeat: 2\n", {"mission.speed=-1"}),
            "--set: mission.speed: -1 is out of range; must be at least 0.1 and at most 100");
  EXPECT_EQ(ErrorMessages("vary: {control.distance: [3]}\n", {"control.distance=2"}),
            "--set: control.distance: the study varies control.distance (study.yaml:4)");
}

TEST_F(Points, HaveTheBisectedKeyWhereItIsAsked) {
  const Study study =
      Read("bisect: {key: mission.speed, from: 1, to: 4, tolerance: 0.1}\nvary: {seed: [3]}\n");
  EXPECT_EQ(StudyPoints(study).Read(0).scenario.mission.speed, 1.0);
  const Scenario scenario = ReadPoint(study, StudyPoints(study).Settings(0), 2.25);
  EXPECT_EQ(scenario.mission.speed, 2.25);
  EXPECT_EQ(scenario.seed, 3U);
}

TEST_F(Points, FindAScenarioThatIsRelativeToTheStudy) {
  const auto file =
      folder_.Write("studies/s.yaml", "schema: 1\nname: s\nscenario: ../small.yaml\nrepeat: 2\n");
  EXPECT_EQ(StudyPoints(ReadStudy(file)).size(), 1U);
}

using Studies = StudyFiles;

TEST_F(Studies, ReportEveryProblemWithItsPlace) {
  EXPECT_EQ(ErrorsOfText(R"(schema: 2
scenario: none.yaml
vari: {}
set: 3
vary:
  mission.speed: 3
  control.distance: []
  drive.plants: [[kinematic]]
  drive.plants: [[mujoco]]
  seed:
  world.friction: {from: 0.2, stop: 1, steps: 0, scale: lin}
list: [{}, here]
repeat: 0
bisect: {from: 3, to: fast}
outputs: [verdict.passed, {a: b}, verdict.passed]
)"),
            R"(study.yaml:1:1: name: missing
study.yaml:1:9: schema: must be 1, found 2
study.yaml:2:11: scenario: cannot read none.yaml: No such file or directory
study.yaml:3:1: vari: unknown key 'vari'; did you mean 'vary'?
study.yaml:4:6: set: expected a section of scenario keys, found '3'
study.yaml:6:18: vary.mission.speed: expected a list of values, or {from, to, steps}, found '3'
study.yaml:7:21: vary.control.distance: expected a list of values, or {from, to, steps}, found an empty list
study.yaml:9:3: vary.drive.plants: duplicate key
study.yaml:10:3: vary.seed: expected a value, found nothing
study.yaml:11:19: vary.world.friction.to: missing
study.yaml:11:31: vary.world.friction.stop: unknown key 'stop'; did you mean 'to'?
study.yaml:11:47: vary.world.friction.steps: 0 is out of range; must be at least 2 and at most 10000
study.yaml:11:57: vary.world.friction.scale: unknown 'lin'; did you mean 'log'?
study.yaml:12:8: list[0]: expected a section of scenario keys, found an empty one
study.yaml:12:12: list[1]: expected a section of scenario keys, found 'here'
study.yaml:13:9: repeat: 0 is out of range; must be at least 1 and at most 100000
study.yaml:14:9: bisect.key: missing
study.yaml:14:9: bisect.tolerance: missing
study.yaml:14:23: bisect.to: expected a number, found 'fast'
study.yaml:15:27: outputs[1]: expected a name, found a section
study.yaml:15:35: outputs[2]: 'verdict.passed' is listed twice)");
}

TEST_F(Studies, RefuseGridsAndBisectionsTheWrongWayRound) {
  EXPECT_EQ(ErrorMessages("vary: {mission.speed: {from: 3, to: 2, steps: 2}}\n"),
            "study.yaml:4:30: vary.mission.speed.from: 3 must be below to: 2");
  EXPECT_EQ(ErrorMessages("vary: {mission.speed: {from: 0, to: 2, steps: 2, scale: log}}\n"),
            "study.yaml:4:30: vary.mission.speed.from: must be above 0 for a geometric scale");
  EXPECT_EQ(ErrorMessages("bisect: {key: mission.speed, from: 2, to: 2, tolerance: 0.1}\n"),
            "study.yaml:4:36: bisect.from: 2 must be below to: 2");
  EXPECT_EQ(
      ErrorMessages("bisect: {key: mission.speed, from: 1, to: 2, tolerance: 0}\n"),
      "study.yaml:4:57: bisect.tolerance: 0 is out of range; must be above 0 and at most 1e+12");
}

TEST_F(Studies, RefuseToVaryNothingOrTooMuch) {
  EXPECT_EQ(ErrorMessages(""),
            "study.yaml:1:1: vary: missing; a study needs vary, list, repeat or bisect");
  EXPECT_EQ(ErrorMessages("vary: {}\n"),
            "study.yaml:4:7: vary: expected a section of scenario keys, found an empty one");
  EXPECT_EQ(ErrorMessages("vary:\nset: {seed: 1}\n"),
            "study.yaml:4:1: vary: expected a section, found nothing");
  EXPECT_EQ(ErrorMessages("list: []\n"),
            "study.yaml:4:7: list: expected a list of points, found an empty one");
  EXPECT_EQ(
      ErrorMessages("vary: {control.distance: {from: 1, to: 2, steps: 1001}}\nrepeat: 10000\n"),
      "study.yaml:1:1: vary: 10010000 runs; at most 10000000");
}

TEST_F(Studies, RefuseToSetWhatIsThenReplaced) {
  EXPECT_EQ(ErrorMessages(R"(set: {mission.speed: 3}
vary: {control.distance: [2, 3]}
list: [{mission.speed: 2}, {control: {method: schedule}}, {world.friction: 0.5}]
bisect: {key: world.friction, from: 0.1, to: 1, tolerance: 0.1}
)"),
            "study.yaml:6:24: mission.speed: overwrites mission.speed, set in line "
            "4\nstudy.yaml:6:38: control: overwrites control.distance, set in line "
            "5\nstudy.yaml:7:9: world.friction: overwrites world.friction, set in line 6");
  EXPECT_EQ(ErrorMessages("vary: {seed: [1, 2]}\nrepeat: 3\n"),
            "study.yaml:4:15: seed: cannot be varied together with repeat, which sets the seed");
  // `repeat` begins with the seed in `set`, and `vary` may refine a section in `set`.
  EXPECT_EQ(ErrorMessages("set: {seed: 5, control: {method: preview}}\nrepeat: 3\n"
                          "vary: {control.distance: [2]}\n"),
            "no error");
}

TEST_F(Studies, TellOfEveryPointsProblemsBeforeAnythingIsDriven) {
  EXPECT_EQ(ErrorMessages(R"(set: {render.camera: chas}
vary:
  mission.sped: [1, 2]
  mission.speed: [3, -1, fast]
  drive.timestep: [0.002, 0.003]
  mission.waypoints[7]: [[1, 2]]
)"),
            "study.yaml:6:18: mission.sped: unknown key 'sped'; did you mean 'speed'?\n"
            "study.yaml:7:22: mission.speed: -1 is out of range; must be at least 0.1 and at most "
            "100\n"
            "study.yaml:7:26: mission.speed: expected a number, found 'fast'\n"
            "study.yaml:9:26: mission.waypoints[7]: element [7] does not exist");
  EXPECT_EQ(ErrorMessages(R"(set: {render.camera: chas}
vary:
  mission.sped: [1, 2]
  mission.speed: [3, -1, fast]
  drive.timestep: [0.002, 0.003]
)"),
            "study.yaml:4:22: render.camera: unknown 'chas'; did you mean 'chase'?\n"
            "study.yaml:6:18: mission.sped: unknown key 'sped'; did you mean 'speed'?\n"
            "study.yaml:7:22: mission.speed: -1 is out of range; must be at least 0.1 and at most "
            "100\n"
            "study.yaml:7:26: mission.speed: expected a number, found 'fast'\n"
            "small.yaml: drive.control_period: 0.02 s is not a whole number of timesteps of "
            "0.003 s (with mission.sped=1, mission.speed=3, drive.timestep=0.003)");
}

TEST_F(Studies, TellOfTheirScenariosOwnProblemsOnce) {
  folder_.Write("small.yaml", std::string(kScenario) + "extra: 1\n");
  EXPECT_EQ(
      ErrorMessages("vary: {mission.speed: [1, 2]}\n"),
      "small.yaml:8:1: extra: unknown key 'extra'; allowed: schema, name, seed, origin, vehicle, "
      "mission, record, world, plan, control, maneuver, drive, disturb, expect, render");
}

TEST_F(Studies, TryBisectionsAtBothEndsAndBetween) {
  EXPECT_EQ(ErrorMessages("bisect: {key: mission.speed, from: 1, to: 400, tolerance: 0.1}\n"),
            "study.yaml:4:9: mission.speed: 400 is out of range; must be at least 0.1 and at most "
            "100");
  // A key with whole numbers cannot be bisected.
  EXPECT_EQ(ErrorMessages("bisect: {key: seed, from: 0, to: 8, tolerance: 1}\n"),
            "study.yaml:4:9: seed: expected a whole number from 0 to 18446744073709551615, found "
            "'3.055728090000841'");
}

TEST_F(Studies, AreToldFromScenariosByTheirScenario) {
  EXPECT_TRUE(IsStudy(folder_.Write("a.yaml", "scenario: x\n")));
  EXPECT_FALSE(IsStudy(folder_.path() / "small.yaml"));
  EXPECT_FALSE(IsStudy(folder_.Write("b.yaml", "scenario: [x\n")));
  EXPECT_FALSE(IsStudy(folder_.path() / "none.yaml"));
  EXPECT_EQ(ErrorsOfText(kScenario),
            "study.yaml: scenario: missing: the file is a scenario; a study names it, and the "
            "values to run it with");
  try {
    ParseScenario("schema: 1\nname: x\nscenario: small.yaml\nvary: {}\n", "x.yaml", ".");
    ADD_FAILURE() << "a study was read as a scenario";
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "x.yaml:3:11: scenario: the file is a study, which has many runs of this scenario; "
        "run it by `sweep`, or give the scenario");
  }
  EXPECT_EQ(ErrorsOfText("- 1\n"),
            "study.yaml:1:1: a study must be a section of 'key: value' lines");
}

TEST(CellText, IsTheShortestFormOfNumbersAndYamlOfTheRest) {
  EXPECT_EQ(CellText("3.0"), "3");
  EXPECT_EQ(CellText("1e3"), "1000");
  EXPECT_EQ(CellText("-0.0"), "0");
  EXPECT_EQ(CellText("[kinematic, mujoco]"), "[kinematic, mujoco]");
  EXPECT_EQ(CellText("3 m"), "3 m");
  EXPECT_EQ(CellText("\"2\""), "\"2\"");
}

TEST(StudyKeys, EachHasALineOfText) {
  const std::vector<KeySection> sections = StudyKeys();
  std::vector<std::string> names;
  for (const KeySection& section : sections) {
    names.push_back(section.key + (section.method.empty() ? "" : " " + section.method));
  }
  EXPECT_THAT(names,
              testing::ElementsAre("", "sample", "search", "bisect", "vary.KEY", "vary.KEY uniform",
                                   "vary.KEY log_uniform", "vary.KEY integer", "vary.KEY normal",
                                   "vary.KEY choice", "vary.KEY file"));
  for (const KeySection& section : sections) {
    for (const KeyInfo& key : section.keys) {
      EXPECT_FALSE(key.text.empty()) << section.key << "." << key.name;
    }
  }
}

}  // namespace
}  // namespace trackbed
