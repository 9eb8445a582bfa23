#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(Compare, DrivesOnePlanOnTheseFourPlants) {
  const TempFolder folder;
  const Outcome outcome =
      Trackbed(folder,
               "compare --plants kinematic,single_track,mujoco:contact,mujoco:magic_formula "
               "--tolerance position=0.2,heading=0.1 --tolerance steering=0.1 " +
                   ScenarioFile("winding"));
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, StartsWith("winding: passed, in out/compare/winding/compare.json\n"
                                         "  kinematic - single_track, from 0 m to "));
  EXPECT_THAT(outcome.output,
              testing::ContainsRegex("\n    position +0\\.[0-9]+ m +at +[0-9.]+ m, +[0-9.]+ s; rms "
                                     "+0\\.[0-9]+ m; at most 0\\.2\n"));
  EXPECT_THAT(outcome.output, HasSubstr("\n  mujoco:contact - mujoco:magic_formula, from 0 m"));
  const std::string json = ReadFile(folder.path() / "out/compare/winding/compare.json");
  EXPECT_THAT(json, HasSubstr("\"steering_max\": 0.1"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/compare/winding/compare.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/compare/winding/single_track.csv"));
}

TEST(Compare, ExceededToleranceIsExitCodeThree) {
  const TempFolder folder;
  const std::string file = ScenarioFile("winding");
  const Outcome outcome = Trackbed(folder, "compare --tolerance position=0.0001 -o c " + file);
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.output, StartsWith("winding: FAILED, in c/compare.json\n"));
  EXPECT_THAT(outcome.output, HasSubstr("at most 0.0001: EXCEEDED\n"));
  EXPECT_THAT(outcome.output,
              testing::ContainsRegex("\n  kinematic and mujoco: position difference 0\\.00[0-9]+ m "
                                     "exceeds 0\\.0001 m at s = [0-9.]+ m, t = [0-9.]+ s\n"));
  EXPECT_EQ(Trackbed(folder, "compare -q --tolerance position=0.0001 " + file).output, "");
  // Without --tolerance the scenario's own bound of 0.1 m applies.
  EXPECT_EQ(Trackbed(folder, "compare -q " + file).code, 0);
  const std::string tight =
      " --set 'expect={between: [{plants: [kinematic, mujoco], yaw_rate_max: 1e-5}]}'";
  EXPECT_EQ(Trackbed(folder, "compare -q " + file + tight).code, 3);
}

TEST(Compare, HoldsFinishedRunsAgainstEachOther) {
  const TempFolder folder;
  const std::string run = "run -q --set 'expect={}' drive.time_limit=8 control.distance=";
  EXPECT_EQ(Trackbed(folder, run + "2 -o a -- " + ScenarioFile("winding")).code, 3);
  EXPECT_EQ(Trackbed(folder, run + "4 -o b -- " + ScenarioFile("winding")).code, 3);
  const Outcome within = Trackbed(folder, "compare a --tolerance position=0.1");
  EXPECT_EQ(within.code, 0) << within.output;
  EXPECT_THAT(within.output, StartsWith("a: passed, in out/compare/compare.json\n"
                                        "  kinematic - mujoco, from 0 m to "));
  const Outcome across = Trackbed(folder, "compare a b --plants kinematic --tolerance heading=0");
  EXPECT_EQ(across.code, 3);
  EXPECT_THAT(across.output, HasSubstr("\n  a/kinematic - b/kinematic, from 0 m to "));
  EXPECT_EQ(across.output.find("mujoco"), std::string::npos);
  EXPECT_THAT(across.output, StartsWith("a and b: FAILED, in out/compare/compare.json\n"));
  // Without --tolerance nothing is judged.
  const Outcome shown = Trackbed(folder, "compare a b");
  EXPECT_EQ(shown.code, 0);
  EXPECT_THAT(shown.output, StartsWith("a and b: compared, no tolerances given, in "));
  // A run equals itself after reading its files.
  const Outcome same = Trackbed(
      folder, "compare a a --tolerance position=0,heading=0,yaw_rate=0,steering=0 -o same");
  EXPECT_EQ(same.code, 0) << same.output;
}

TEST(Compare, AgreesWithTheFiguresOfTheRun) {
  const TempFolder folder;
  EXPECT_EQ(Trackbed(folder, "run -q -o r " + ScenarioFile("winding")).code, 0);
  EXPECT_EQ(Trackbed(folder, "compare -q r -o c").code, 0);
  const auto between = nlohmann::json::parse(ReadFile(folder.path() / "r/metrics.json"))["between"];
  auto pair = nlohmann::json::parse(ReadFile(folder.path() / "c/compare.json"))["pairs"][0];
  pair.erase("tolerances");
  EXPECT_EQ(pair, between[0]);
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const TempFolder folder;
  const std::string file = ScenarioFile("winding");
  const auto told = [&](const std::string& arguments) {
    const Outcome outcome = Trackbed(folder, "compare " + arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    return outcome.output;
  };
  EXPECT_EQ(told("--plants mujoco " + file),
            "winding: drive.plants: only mujoco; comparing needs two plants, such as --plants "
            "kinematic,mujoco\n");
  EXPECT_EQ(told("--tolerance positon=1 " + file),
            "--tolerance: unknown 'positon'; did you mean 'position'?\n");
  EXPECT_EQ(told("."), ".: not the folder of a finished run (no metrics.json)\n");
  EXPECT_EQ(told(". " + file),
            "give scenario files or one or two folders of finished runs, not both\n");
  EXPECT_EQ(told(". --seed 3"), "--set and --seed apply to scenarios, not to finished runs\n");
  EXPECT_THAT(told(file + " " + file), HasSubstr("both would write to out/compare/winding\n"));
  EXPECT_THAT(told("none.yaml"), StartsWith("cannot read none.yaml"));
  EXPECT_TRUE(folder.Names().empty());
}

TEST(Compare, NamesThePlanThatLacksAColumn) {
  const TempFolder folder;
  for (const char* out : {"a", "b"}) {
    ASSERT_EQ(Trackbed(folder, "run -q --plant kinematic --set expect={} drive.time_limit=0.2 -o " +
                                   std::string(out) + " -- " + ScenarioFile("winding"))
                  .code,
              3);
  }
  std::filesystem::remove(folder.path() / "b/manifest.json");
  std::string plan = ReadFile(folder.path() / "b/plan.csv");
  plan.replace(plan.find("yaw_rad"), 7, "heading");
  folder.Write("b/plan.csv", plan);
  for (const char* runs : {"a b", "b a"}) {
    const Outcome refused = Trackbed(folder, std::string("compare ") + runs);
    EXPECT_EQ(refused.code, 2);
    EXPECT_EQ(refused.output, "b/plan.csv:1: yaw_rad: no such column\n");
  }
}

TEST(Test, RunsManyAtOnceInTheOrderOfTheFiles) {
  const TempFolder folder;
  folder.Write("s/a.yaml", ReadFile(ScenarioFile("three_turns")));
  folder.Write("s/b.yaml", "schema: 1\nname: bad\nmission: {sped: 3}\n");
  folder.Write("s/c.yaml", ReadFile(ScenarioFile("winding")));
  const std::string options =
      " --plant kinematic --set 'expect={reach_goal: 0.5, metrics: [{metric: time, max: 48}]}'";
  const std::string lines =
      "pass s/a.yaml: all expectations met\nFAIL s/c.yaml: kinematic: time 48.84 s exceeds 48 s at "
      "the end, s = 143.5 m, t = 48.84 s\n3 scenarios: 1 passed, 1 failed, 1 with wrong input\n";
  for (const char* jobs : {"1", "3"}) {
    const Outcome outcome =
        Trackbed(folder, std::string("test s --jobs ") + jobs + options + " 2>errors");
    EXPECT_EQ(outcome.code, 2);  // invalid input outranks a failed expectation
    EXPECT_EQ(Verdicts(outcome.output), lines);
    EXPECT_THAT(ReadFile(folder.path() / "errors"),
                HasSubstr("s/b.yaml:3:11: mission.sped: unknown key 'sped'"));
  }
}

TEST(Test, WritesJUnit) {
  const TempFolder folder;
  folder.Write("s/bad.yaml", "schema: 1\nname: bad\nmission: {sped: 3}\n");
  const std::string options =
      " --plant kinematic --set 'expect={max_cross_track: 0.001}' --junit out/j/report.xml";
  EXPECT_EQ(Trackbed(folder, "test -q " + ScenarioFile("winding") + " s" + options).code, 2);
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.LoadFile((folder.path() / "out/j/report.xml").c_str()), tinyxml2::XML_SUCCESS);
  const auto* suite = document.RootElement()->FirstChildElement("testsuite");
  EXPECT_EQ(suite->IntAttribute("tests"), 2);
  EXPECT_EQ(suite->IntAttribute("failures"), 1);
  EXPECT_EQ(suite->IntAttribute("errors"), 1);
  const auto* failed = suite->FirstChildElement("testcase");
  EXPECT_STREQ(failed->Attribute("name"), "winding");
  EXPECT_THAT(failed->FirstChildElement("failure")->Attribute("message"),
              testing::MatchesRegex("kinematic: maximum cross-track error 0\\.[0-9]+ m exceeds "
                                    "0\\.001 m at s = [0-9.]+ m, t = [0-9.]+ s"));
  const auto* error = failed->NextSiblingElement()->FirstChildElement("error");
  EXPECT_THAT(error->GetText(), HasSubstr("mission.sped: unknown key 'sped'"));
  // The folder of the report contains nothing else; if the report cannot be written, nothing is
  // simulated.
  EXPECT_EQ(Shell(folder, "ls -A out/j").output, "report.xml\n");
  folder.Write("taken", "a file");
  const Outcome taken =
      Trackbed(folder, "test --plant kinematic --junit taken/x.xml -- " + ScenarioFile("winding"));
  EXPECT_EQ(taken.code, 2);
  EXPECT_EQ(taken.output, "cannot create the folder ./taken: Not a directory\n");
  const Outcome out =
      Trackbed(folder, "test --plant kinematic --junit out -- " + ScenarioFile("winding"));
  EXPECT_EQ(out.code, 2);
  EXPECT_EQ(out.output, "cannot write out: Is a directory\n");
}

TEST(Test, GoesThroughFoldersAndTakesEveryScenarioOnce) {
  const TempFolder folder;
  const std::string scenario = ReadFile(ScenarioFile("winding"));
  for (const char* name : {"s/b.yaml", "s/a/deep/c.yml", "s/.git/hidden.yaml", "s/a.txt"}) {
    folder.Write(name, scenario);
  }
  folder.Write("s/study.yaml", "schema: 1\nname: study\nscenario: b.yaml\n");
  std::filesystem::create_directory_symlink("..", folder.path() / "s/a/round");
  std::filesystem::create_directory(folder.path() / "empty");
  const std::string options = "test --jobs 1 --plant kinematic --set 'expect={}' --junit j.xml -- ";
  const Outcome outcome = Trackbed(folder, options + "empty ./s/b.yaml s s/a/../b.yaml 2>errors");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(Verdicts(outcome.output),
            "pass ./s/b.yaml: all expectations met\npass s/a/deep/c.yml: all expectations met\n"
            "3 scenarios: 2 passed, 1 with wrong input\n");
  EXPECT_EQ(ReadFile(folder.path() / "errors"),
            "empty: the folder has no scenarios (*.yaml, *.yml)\n");
  EXPECT_THAT(ReadFile(folder.path() / "j.xml"),
              HasSubstr("tests=\"3\" failures=\"0\" errors=\"1\""));
}

TEST(Test, CtrlCSkipsTheRest) {
  const TempFolder folder;
  folder.Write("s/a.yaml", ReadFile(ScenarioFile("winding")));
  // The first line appears when the first scenario has finished; the second would take minutes.
  std::string slow = ReadFile(ScenarioFile("three_turns"));
  const std::string drive = "drive: {plants: [kinematic, mujoco]}";
  slow.replace(slow.find(drive), drive.size(), "drive: {timestep: 0.00002}");
  folder.Write("s/b.yaml", slow);
  const Outcome outcome =
      Trackbed(folder,
               "test s --jobs 1 --junit j.xml >lines & n=0; until [ -s lines ] || [ "
               "$n -gt 600 ]; do n=$((n + 1)); sleep 0.1; done; kill -INT $!; wait $!");
  EXPECT_EQ(outcome.code, 130) << outcome.output;
  EXPECT_EQ(Verdicts(ReadFile(folder.path() / "lines")),
            "pass s/a.yaml: all expectations met\n2 scenarios: 1 passed, 1 not finished\n");
  EXPECT_THAT(ReadFile(folder.path() / "j.xml"), HasSubstr("<skipped message=\"interrupted\"/>"));
}

}  // namespace
}  // namespace trackbed
