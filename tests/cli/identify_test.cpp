#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "trackbed/core/file.h"
#include "trackbed/core/file_name.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kScenarios = fs::path(TRACKBED_SOURCE_DIR) / "scenarios";

/// A study that identifies parameters of the single-track model for the recorded 1:10 car.
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

/// Writes the model of the car DART, under the name `name`, and its scenario to `folder`.
void WriteDart(const TempFolder& folder, const std::string& model, const std::string& name) {
  const fs::path source = TRACKBED_SOURCE_DIR;
  fs::create_directories((folder.path() / model).parent_path());
  fs::copy(source / "models/dart", (folder.path() / model).parent_path(),
           fs::copy_options::recursive | fs::copy_options::skip_existing);
  std::string xml = ReadFile(source / "models/dart/dart.xml");
  const std::string begin = "<mujoco model=\"dart\"";
  xml.replace(xml.find(begin), begin.size(), "<mujoco model=\"" + name + "\"");
  folder.Write(model, xml);
  folder.Write("dart.yaml",
               "schema: 1\nname: record\nvehicle: {model: " + (folder.path() / model).string() +
                   "}\nmission: {}\nrecord: {file: ramp.csv, map: map.yaml}\n"
                   "control: {method: playback, speed: {gain: 20}}\n"
                   "drive: {plants: [recorded, kinematic], control_period: 0.01, timestep: "
                   "0.002}\n");
  fs::copy_file(source / "tests/data/dart/ramp_steer_02.csv", folder.path() / "ramp.csv",
                fs::copy_options::skip_existing);
  fs::copy_file(source / "scenarios/real/maps/dart.yaml", folder.path() / "map.yaml",
                fs::copy_options::skip_existing);
  folder.Write("study.yaml",
               "schema: 1\nname: small\nfit: [dart.yaml]\nstarts: 1\nevaluations: 1\nparameters: "
               "[{name: yaw_inertia, from: 0.001, to: 0.1}]\n");
}

TEST(Identify, NamesItsModelSafely) {
  for (const std::string& name :
       {std::string("../../../victim/rel"), std::string("a/b"), std::string("..")}) {
    const TempFolder folder;
    WriteDart(folder, "model/dart.xml", name);
    folder.Write("victim/rel.xml", "mine");
    const Outcome found = Trackbed(folder, "identify study.yaml -o deep/er/out");
    EXPECT_EQ(found.code, 0) << found.output;
    EXPECT_EQ(ReadFile(folder.path() / "victim/rel.xml"), "mine");
    EXPECT_TRUE(fs::exists(folder.path() / "deep/er/out" / (FileNameOf(name) + ".xml")));
    EXPECT_EQ(Trackbed(folder, "report -q deep/er/out").code, 0);
  }
}

TEST(Identify, LeavesTheModelThatItStartsFrom) {
  const TempFolder folder;
  WriteDart(folder, "dart.xml", "dart");
  const std::string model = ReadFile(folder.path() / "dart.xml");
  const Outcome refused = Trackbed(folder, "identify study.yaml -o .");
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.output,
            ". has files that Trackbed has not written, according to its manifest.json: dart.xml; "
            "move them away, or choose another folder (-o)\n");
  EXPECT_EQ(ReadFile(folder.path() / "dart.xml"), model);
}

// A process that is killed between writing the runs and the estimates leaves files of two different
// identifications.
TEST(Identify, TakesNoRecordOfAnotherIdentification) {
  const TempFolder folder;
  WriteDart(folder, "model/dart.xml", "dart");
  ASSERT_EQ(Trackbed(folder, "identify -q study.yaml -o out").code, 0);
  EXPECT_EQ(Trackbed(folder, "report -q out").code, 0);
  ASSERT_EQ(Trackbed(folder, "run -q dart.yaml -o out/records/record --plant kinematic").code, 0);
  const Outcome mixed = Trackbed(folder, "report -q out");
  EXPECT_EQ(mixed.code, 2);
  EXPECT_THAT(mixed.output, HasSubstr("out/records/record: has another result than identify.json"));
  // Changes a file of the identification itself.
  ASSERT_EQ(Trackbed(folder, "identify -q study.yaml -o out").code, 0);
  folder.Write("out/record.residuals.csv",
               ReadFile(folder.path() / "out/record.residuals.csv") + " ");
  EXPECT_THAT(Trackbed(folder, "report -q out").output, HasSubstr("does not belong to this run"));
}

TEST(Identify, RefusesRecordsOfOneName) {
  const TempFolder folder;
  WriteDart(folder, "model/dart.xml", "dart");
  std::string study = ReadFile(folder.path() / "study.yaml");
  folder.Write("study.yaml", study + "held_out: [dart.yaml]\n");
  const Outcome refused = Trackbed(folder, "identify study.yaml -o out");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.output, HasSubstr("held_out[0]: its scenario has the name 'record', as one"));
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
