#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/cli/program.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

std::string RunArguments(const std::string& out) {
  return "run -q " + ScenarioFile("winding") +
         " --plant kinematic --set 'expect={}' --set drive.time_limit=1 -o " + out;
}

TEST(Report, WritesAPageIntoTheRunsFolder) {
  const TempFolder folder;
  Trackbed(folder, RunArguments("a"));
  const Outcome outcome = Trackbed(folder, "report a");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_EQ(outcome.output, "a/report.html\n");
  const std::string page = ReadFile(folder.path() / "a/report.html");
  EXPECT_THAT(page, testing::StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(page, EndsWith("</html>\n"));
  EXPECT_THAT(page, HasSubstr("<title>a</title>"));
  EXPECT_EQ(Trackbed(folder, "report a -q -o new/b.html").output, "");
  EXPECT_EQ(ReadFile(folder.path() / "new/b.html"), page);
  Trackbed(folder, RunArguments("a") + " --report");
  EXPECT_EQ(ReadFile(folder.path() / "a/report.html"), page);
  // A new run into the folder removes the report of the old one.
  Trackbed(folder, RunArguments("a"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a/report.html"));
}

TEST(Report, WritesThatOfSeveralRunsHere) {
  const TempFolder folder;
  Trackbed(folder, RunArguments("a"));
  Trackbed(folder, RunArguments("b"));
  const Outcome outcome = Trackbed(folder, "report a b/");
  EXPECT_EQ(outcome.output, "report.html\n");
  EXPECT_THAT(ReadFile(folder.path() / "report.html"), HasSubstr("<title>a · b</title>"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a/report.html"));
}

TEST(Report, WritesThatOfAComparisonBesideIt) {
  const TempFolder folder;
  Trackbed(folder, RunArguments("runs/a"));
  Trackbed(folder, RunArguments("runs/b"));
  EXPECT_EQ(Trackbed(folder, "compare -q runs/a runs/b -o both").code, 0);
  EXPECT_EQ(Trackbed(folder, "report both").output, "both/report.html\n");
  EXPECT_THAT(ReadFile(folder.path() / "both/report.html"), HasSubstr("<title>a · b</title>"));
  // A comparison and its runs moved together stay linked.
  std::filesystem::create_directory(folder.path() / "moved");
  std::filesystem::rename(folder.path() / "both", folder.path() / "moved/both");
  std::filesystem::rename(folder.path() / "runs", folder.path() / "moved/runs");
  EXPECT_EQ(Trackbed(folder, "report moved/both").output, "moved/both/report.html\n");
  std::filesystem::remove_all(folder.path() / "moved/runs/b");
  const Outcome outcome = Trackbed(folder, "report moved/both");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.output,
            "moved/both: the compared run in moved/runs/b does not exist (no metrics.json)\n");
}

TEST(Report, WritesThatOfAStudyBesideItsTable) {
  const TempFolder folder;
  folder.Write("study.yaml",
               "schema: 1\nname: study\nscenario: " + ScenarioFile("winding") +
                   "\nset: {drive.plants: [kinematic], drive.time_limit: 1, expect: {}}\n"
                   "vary: {mission.speed: [2, 3]}\n"
                   "outputs: [metrics.kinematic.distance]\n");
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml").code, 0);
  EXPECT_EQ(Trackbed(folder, "report out/study").output, "out/study/report.html\n");
  EXPECT_THAT(ReadFile(folder.path() / "out/study/report.html"),
              HasSubstr("\"metrics.kinematic.distance\""));
  EXPECT_EQ(Trackbed(folder, "report out/study/sweep.csv -o x.html").code, 0);
  EXPECT_EQ(ReadFile(folder.path() / "x.html"), ReadFile(folder.path() / "out/study/report.html"));
  ASSERT_EQ(Trackbed(folder, "sweep -q study.yaml").code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/study/report.html"));
}

TEST(Report, RefusesWhatIsNoRun) {
  const TempFolder folder;
  folder.Write("empty/x.txt", "");
  Outcome outcome = Trackbed(folder, "report gone");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.output, "gone: no such folder\n");
  outcome = Trackbed(folder, "report empty");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output,
              HasSubstr("empty: not a finished run (no metrics.json), a comparison"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "empty/report.html"));
  outcome = Trackbed(folder, "report");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output, testing::StartsWith("missing DIR\n"));
  outcome = Trackbed(folder, "check-path path.csv");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output, testing::StartsWith("missing --speed SPEED\n"));
  const auto told = [&](const std::string& film) {
    const Outcome refused = Trackbed(folder, "report empty --film " + film);
    EXPECT_EQ(refused.code, 2);
    return refused.output;
  };
  EXPECT_EQ(told("besides"), "--film: unknown 'besides'; did you mean 'beside'?\n");
  EXPECT_EQ(told("1"), "--film: unknown '1'; allowed: embedded, beside, none\n");
  Trackbed(folder, RunArguments("a"));
  outcome = Trackbed(folder, "report a -o a/metrics.json/page.html");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("a/metrics.json"));
  outcome = Trackbed(folder, "report a -o /dev/full");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("cannot write /dev/full"));
}

}  // namespace
}  // namespace trackbed
