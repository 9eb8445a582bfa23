#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/program.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

using testing::HasSubstr;

std::string SearchText(const std::string& limit, const std::string& search) {
  return "schema: 1\nname: reach\nscenario: " + ScenarioFile("winding") +
         "\nset: {drive.plants: [kinematic], expect: {max_cross_track: " + limit +
         "}}\n"
         "vary:\n"
         "  control.distance: {distribution: uniform, from: 2, to: 10}\n"
         "  mission.speed: {distribution: uniform, from: 1, to: 3}\n"
         "nominal: {control.distance: 2.5, mission.speed: 2}\n" +
         search;
}

TEST(FalsifyVerb, EndsBeforeItsFirstRun) {
  const TempFolder folder;
  // A run takes minutes. The output folder appears before the first run; the loop gives up after a
  // minute.
  folder.Write("study.yaml", "schema: 1\nname: reach\nscenario: " + ScenarioFile("winding") +
                                 "\nset: {drive.plants: [mujoco], drive.timestep: 0.00001}\n"
                                 "vary: {mission.speed: {distribution: uniform, from: 1, to: 3}}\n"
                                 "search: {runs: 7, shrink_runs: 2}\n");
  const Outcome outcome =
      Trackbed(folder,
               "falsify study.yaml -j 1 -o r --report & n=0; until [ -d r ] || [ $n -gt 600 ]; do "
               "n=$((n + 1)); sleep 0.1; done; kill -INT $!; wait $!");
  EXPECT_EQ(outcome.code, 130) << outcome.output;
  const std::string table = ReadFile(folder.path() / "r/sweep.json");
  EXPECT_THAT(table, HasSubstr("\"complete\": false"));
  EXPECT_THAT(table, HasSubstr("\"rows_expected\": 10"));
}

TEST(FalsifyVerb, LeavesACounterexampleForATestSuite) {
  const TempFolder folder;
  folder.Write("study.yaml", SearchText("0.3", "search: {runs: 30}\n"));
  const Outcome outcome = Trackbed(folder, "falsify study.yaml --jobs 2 --report");
  EXPECT_EQ(outcome.code, 3) << outcome.output;
  EXPECT_THAT(outcome.output, testing::ContainsRegex("reach: broken: [12] of [0-9]+ runs failed"));
  EXPECT_THAT(outcome.output, HasSubstr("kinematic: maximum cross-track error"));
  EXPECT_THAT(outcome.output,
              testing::ContainsRegex("control\\.distance +2\\.5 +[0-9.]+ +[0-9.]+"));
  EXPECT_THAT(outcome.output, HasSubstr("out/reach/counterexample/counterexample.yaml\n"));
  const std::filesystem::path out = folder.path() / "out/reach";
  for (const char* name : {"sweep.csv", "sweep.json", "falsify.json", "report.html",
                           "counterexample/kinematic.csv", "counterexample/report.html"}) {
    EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
  }
  EXPECT_THAT(ReadFile(out / "report.html"), HasSubstr(R"("search":{"status":"broken",)"));
  // The counterexample's file states the observed result and passes; its scenario with the original
  // expectations fails.
  EXPECT_EQ(Trackbed(folder, "test out/reach/counterexample/counterexample.yaml").code, 0);
  const auto json = nlohmann::json::parse(ReadFile(out / "falsify.json"));
  const std::string distance =
      json.at("counterexample").at("settings").at("control.distance").dump();
  EXPECT_EQ(Trackbed(folder, "run -q " + ScenarioFile("winding") +
                                 " --plant kinematic --set control.distance=" + distance +
                                 " mission.speed=2 expect='{max_cross_track: 0.3}'")
                .code,
            3);
  // A repetition reads the records without a run.
  const Outcome again = Trackbed(folder, "falsify study.yaml --jobs 1");
  EXPECT_EQ(again.code, 3);
  EXPECT_THAT(again.output, HasSubstr("runs are there already"));
  EXPECT_EQ(nlohmann::json::parse(ReadFile(out / "falsify.json")), json);
  // A corrected scenario leaves no counterexample.
  folder.Write("study.yaml", SearchText("30", "search: {runs: 5}\n"));
  EXPECT_THAT(Trackbed(folder, "falsify study.yaml").output,
              HasSubstr("has rows of another study"));
  const Outcome held = Trackbed(folder, "falsify study.yaml --restart");
  EXPECT_EQ(held.code, 0) << held.output;
  EXPECT_THAT(held.output, testing::ContainsRegex(
                               "reach: not falsified in [56] runs; the lowest robustness is "));
  EXPECT_FALSE(std::filesystem::exists(out / "counterexample"));
}

TEST(FalsifyVerb, LeavesTheUsersFilesBesideTheCounterexample) {
  const TempFolder folder;
  folder.Write("study.yaml", SearchText("0.3", "search: {runs: 30, shrink_runs: 0}\n"));
  ASSERT_EQ(Trackbed(folder, "falsify -q study.yaml --jobs 2 --report").code, 3);
  const std::filesystem::path found = folder.path() / "out/reach/counterexample";
  folder.Write("out/reach/counterexample/notes.txt", "mine");
  folder.Write("out/reach/counterexample/video.mp4", "mine");
  folder.Write("study.yaml", SearchText("30", "search: {runs: 2}\n"));
  const Outcome refused = Trackbed(folder, "falsify -q study.yaml --restart");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.output, HasSubstr("counterexample has files that Trackbed has not written"));
  EXPECT_THAT(refused.output, HasSubstr("manifest.json: video.mp4; "));
  std::filesystem::rename(found / "video.mp4", found / "mine.mp4");
  EXPECT_EQ(Trackbed(folder, "falsify -q study.yaml --restart").code, 0);
  std::vector<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(found)) {
    left.push_back(entry.path().filename());
  }
  EXPECT_THAT(left, testing::UnorderedElementsAre("notes.txt", "mine.mp4"));
  // The counterexample's folder is now a link to a folder of the user.
  std::filesystem::rename(found, folder.path() / "mine");
  std::filesystem::create_directory_symlink(folder.path() / "mine", found);
  const Outcome linked = Trackbed(folder, "falsify -q study.yaml --restart");
  EXPECT_EQ(linked.code, 2);
  EXPECT_THAT(linked.output, HasSubstr("counterexample: it is a link, not a folder"));
  EXPECT_EQ(ReadFile(folder.path() / "mine/notes.txt"), "mine");
}

// A process that is killed between writing the counterexample and the outcome leaves files of two
// different searches.
TEST(FalsifyVerb, TakesNoCounterexampleOfAnotherSearch) {
  const TempFolder folder;
  folder.Write("study.yaml", SearchText("0.3", "search: {runs: 30, shrink_runs: 0}\n"));
  ASSERT_EQ(Trackbed(folder, "falsify -q study.yaml --jobs 2").code, 3);
  EXPECT_EQ(Trackbed(folder, "report -q out/reach").code, 0);
  EXPECT_EQ(Trackbed(folder, "run -q " + ScenarioFile("winding") +
                                 " --plant kinematic -o out/reach/counterexample"
                                 " --set drive.time_limit=0.1 expect={}")
                .code,
            3);  // the car does not arrive
  const Outcome mixed = Trackbed(folder, "report -q out/reach");
  EXPECT_EQ(mixed.code, 2);
  EXPECT_THAT(mixed.output,
              HasSubstr("out/reach/counterexample: has another result than falsify.json tells of"));
  // Repeating the same command repairs the folder.
  EXPECT_EQ(Trackbed(folder, "falsify -q study.yaml").code, 3);
  EXPECT_EQ(Trackbed(folder, "report -q out/reach").code, 0);
}

TEST(FalsifyVerb, HasNoMarginsWhereTheNominalPointFails) {
  const TempFolder folder;
  folder.Write("study.yaml", SearchText("0.0001", "search: {runs: 5}\n"));
  const Outcome outcome = Trackbed(folder, "falsify study.yaml");
  EXPECT_EQ(outcome.code, 3) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("distance 0 from the nominal point after 0 runs"));
  EXPECT_THAT(outcome.output, testing::Not(HasSubstr("sensitivity")));
}

TEST(FalsifyVerb, EndsWhenTheTimeIsUp) {
  const TempFolder folder;
  folder.Write("study.yaml", SearchText("30", "search: {runs: 1000, method: random}\n"));
  const Outcome outcome = Trackbed(folder, "falsify study.yaml --time 0");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("not falsified in 9 runs (the time was up)"));
}

TEST(FalsifyVerb, TellsOfBadInputBeforeAnythingIsRun) {
  const TempFolder folder;
  folder.Write("study.yaml", SearchText("0.3", "search: {runs: 0}\n"));
  const Outcome outcome = Trackbed(folder, "falsify study.yaml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("search.runs: "));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
  folder.Write("study.yaml", SearchText("0.3", "search: {}\n"));
  EXPECT_EQ(Trackbed(folder, "check study.yaml").code, 0);
  // The points of a search are not a sample, so `sweep` refuses the study of a search.
  const Outcome sweep = Trackbed(folder, "sweep study.yaml");
  EXPECT_EQ(sweep.code, 2);
  EXPECT_THAT(sweep.output, HasSubstr("sample: missing; keys of vary have distributions"));
}

std::string VerifyText(const std::string& limit, const std::string& sample) {
  return "schema: 1\nname: sure\nscenario: " + ScenarioFile("winding") +
         "\nset: {drive.plants: [kinematic], drive.time_limit: 5, expect: {metrics: [{metric: "
         "status, equals: time_limit}, {metric: cross_track.max, max: " +
         limit +
         "}]}}\nvary: {mission.speed: {distribution: uniform, from: 1, to: 3}}\nsample: " + sample +
         "\n";
}

TEST(VerifyVerb, StopsAsSoonAsItIsKnown) {
  const TempFolder folder;
  folder.Write("study.yaml", VerifyText("1", "{count: 500, method: random}"));
  // 88 successive passes suffice, by the closed form of tests/falsify/sequential_test_test.cpp.
  const Outcome outcome = Trackbed(folder, "verify study.yaml --probability 0.95 --jobs 2");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              HasSubstr("sure: a run passes with a probability of at least 0.95, at "
                        "95 % confidence: 88 of 88 runs passed"));
  const auto json = nlohmann::json::parse(ReadFile(folder.path() / "out/sure_verify/verify.json"));
  EXPECT_EQ(json.at("verdict"), "at_least");
  EXPECT_EQ(json.at("runs"), 88);
}

TEST(VerifyVerb, SaysWhatIsNotShown) {
  const TempFolder folder;
  folder.Write("study.yaml", VerifyText("-1", "{count: 500, method: random}"));
  const Outcome outcome = Trackbed(folder, "verify study.yaml --probability 0.95");
  EXPECT_EQ(outcome.code, 3) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("sure: a run passes with a probability below 0.95"));
  folder.Write("study.yaml", VerifyText("1", "{count: 20, method: random}"));
  const Outcome few = Trackbed(folder, "verify study.yaml --probability 0.95 --restart");
  EXPECT_EQ(few.code, 3);
  EXPECT_THAT(few.output, HasSubstr("sure: not known whether a run passes with a probability of at "
                                    "least 0.95: 20 of 20 runs passed, too few to tell at 95 % "
                                    "confidence"));
  folder.Write("study.yaml", VerifyText("1", "{count: 20}"));
  const Outcome dependent = Trackbed(folder, "verify study.yaml");
  EXPECT_EQ(dependent.code, 2);
  EXPECT_THAT(dependent.output, HasSubstr("sample.method: must be random: the points of other "
                                          "samples are not independent of each other"));
  EXPECT_EQ(Trackbed(folder, "verify study.yaml --probability 1").code, 2);
}

}  // namespace
}  // namespace trackbed
