#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kScenarios = fs::path(TRACKBED_SOURCE_DIR) / "scenarios";

/// A study of the recorded 1:10 car on the single-track model.
std::string StudyOfDart(const std::string& parameters, const std::string& rest = "") {
  return "schema: 1\nname: small\nfit: [" + (kScenarios / "real/dart_ramp_02.yaml").string() +
         "]\nparameters:\n" + parameters + "starts: 1\n" + rest;
}

TEST(Identify, EstimatesAndWritesAModelThatRuns) {
  const TempFolder folder;
  folder.Write("study.yaml", StudyOfDart("  - {name: p_ky1_front, from: -20, to: -2}\n"
                                         "  - {name: p_dy1_front, from: 0.5, to: 1.5}\n"));
  const Outcome found = Trackbed(folder, "identify study.yaml -o out --report");
  EXPECT_EQ(found.code, 0) << found.output;
  EXPECT_THAT(found.output, HasSubstr("small: finished, cost"));
  EXPECT_THAT(found.output,
              HasSubstr("not identified: it has no effect on the plant single_track"));
  EXPECT_THAT(found.output, HasSubstr("dart_ramp_02"));
  const auto json = nlohmann::json::parse(ReadFile(folder.path() / "out/identify.json"));
  EXPECT_EQ(json["parameters"][0]["status"], "identified");
  EXPECT_LT(json["cost"]["fitted"], json["cost"]["start"]);
  EXPECT_THAT(ReadFile(folder.path() / "out/report.html"), HasSubstr("\"identification\""));
  const Outcome model = Trackbed(folder, "model out/dart.xml");
  EXPECT_EQ(model.code, 0) << model.output;
  const Outcome page = Trackbed(folder, "report out/records/dart_ramp_02 -o record.html");
  EXPECT_EQ(page.code, 0) << page.output;
}

TEST(Identify, NamesWhatIsWrongWithItsPlace) {
  const TempFolder folder;
  const auto message = [&](const std::string& text) {
    folder.Write("study.yaml", text);
    const Outcome outcome = Trackbed(folder, "identify study.yaml -o out");
    EXPECT_EQ(outcome.code, 2) << outcome.output;
    EXPECT_FALSE(fs::exists(folder.path() / "out/identify.json"));
    return outcome.output;
  };
  EXPECT_THAT(message(StudyOfDart("  - {name: p_ky1_frnt, from: -20, to: -2}\n")),
              HasSubstr("study.yaml:5:12: parameters: p_ky1_frnt: no such number in the model: "
                        "'p_ky1_frnt'; did you mean 'p_ky1_front'?"));
  EXPECT_THAT(message(StudyOfDart("  - {name: mass, from: 2, to: 1}\n")),
              HasSubstr("study.yaml:5:31: parameters[0].to: must be above from, 2; found 1"));
  EXPECT_THAT(message(StudyOfDart("  - {name: mass, from: 1, to: 2, start: 3}\n")),
              HasSubstr("parameters[0].start: must be between 1 and 2; found 3"));
  EXPECT_THAT(
      message(StudyOfDart("  - {name: mass, from: 1, to: 2}\n  - {name: mass, from: 1, to: 2}\n")),
      HasSubstr("parameters[1].name: 'mass' is estimated already"));
  EXPECT_THAT(message(StudyOfDart("  - {name: mass, from: 1, to: 2}\n", "horzon: 1\n")),
              HasSubstr("study.yaml:7:1: horzon: unknown key 'horzon'; did you mean 'horizon'?"));
  EXPECT_THAT(message(StudyOfDart("  - {name: mass, from: 1, to: 2}\n", "horizon: 1000\n")),
              HasSubstr("no record has 1000 s in a row that are valid and fast enough"));
  EXPECT_THAT(message("schema: 1\nname: x\nfit: [" + (kScenarios / "three_turns.yaml").string() +
                      "]\nparameters: [{name: mass, from: 1, to: 2}]\n"),
              HasSubstr("three_turns.yaml has no record to compare with"));
}

TEST(Identify, IsCheckedWithoutBeingRun) {
  const TempFolder folder;
  for (const char* study : {"identify_single_track", "identify_mujoco"}) {
    const Outcome checked = Trackbed(
        folder, "check " + (kScenarios / "real" / (std::string(study) + ".yaml")).string());
    EXPECT_EQ(checked.code, 0) << checked.output;
  }
}

}  // namespace
}  // namespace trackbed
