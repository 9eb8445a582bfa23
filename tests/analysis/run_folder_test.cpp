#include "trackbed/analysis/run_folder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "trackbed/analysis/compare_runs.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/sim/plant.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

Scenario Read(const std::string& name, const std::vector<Override>& overrides) {
  return ReadScenario(fs::path(TRACKBED_SOURCE_DIR) / "scenarios" / (name + ".yaml"), overrides);
}

// Users' scripts rely on these names, which docs/cli.md lists.
TEST(RunFolder, NamesItsFilesAsDocumented) {
  EXPECT_THAT(run_folder::AllNames(), testing::IsSupersetOf({"scenario.resolved.yaml",
                                                             "model.xml",
                                                             "plan.csv",
                                                             "plan.json",
                                                             "schedule.csv",
                                                             "convergence.csv",
                                                             "tree.csv",
                                                             "timing.json",
                                                             "run.mcap",
                                                             "manifest.json",
                                                             "recording.csv",
                                                             "path.csv",
                                                             "bank.csv",
                                                             "road_network.xodr",
                                                             "metrics.json",
                                                             "video.mp4",
                                                             "picture.png",
                                                             "report.html",
                                                             "compare.csv",
                                                             "compare.json",
                                                             "kinematic.csv",
                                                             "kinematic.state.csv",
                                                             "kinematic.plan.csv",
                                                             "kinematic.plan.json",
                                                             "kinematic.tree.csv",
                                                             "mujoco-magic_formula.state.csv"}));
  // Five files per plant and twenty-six others.
  EXPECT_EQ(run_folder::AllNames().size(), 5 * DrivenPlantNames().size() + 26);
  EXPECT_STREQ(run_folder::kSweepCsv, "sweep.csv");
  EXPECT_STREQ(run_folder::kSweepJson, "sweep.json");
}

TEST(RunFolder, IsNotLeftThroughNamesOrLinks) {
  for (const char* plant : {"../../secret", "/etc/passwd", "", ".hidden", "a/b"}) {
    EXPECT_EQ(ErrorText([&] { run_folder::LogCsv(plant); }),
              fmt::format("'{}' is no name of a plant", plant));
  }
  const TempFolder folder;
  const fs::path secret = folder.Write("secret.csv", "t_s\n0\n");
  const fs::path own = folder.Write("run/own.csv", "t_s\n0\n");
  const fs::path link = folder.path() / "run/mujoco.csv";
  fs::create_symlink(secret, link);
  EXPECT_EQ(ErrorText([&] { run_folder::RequireFile(link); }),
            link.string() + ": is a link out of the run folder");
  EXPECT_EQ(ErrorText([&] { run_folder::RequireFile(own); }), "");
  // The folder itself may be reached through a link.
  fs::create_symlink(folder.path() / "run", folder.path() / "latest");
  EXPECT_EQ(ErrorText([&] { run_folder::RequireFile(folder.path() / "latest/own.csv"); }), "");
}

TEST(RunFolder, RepeatsAPlaybackFromItsOwnRecording) {
  const TempFolder folder;
  const auto out = [&](const char* name) { return folder.path() / name; };
  const auto run = [&](const Scenario& scenario, const char* name) {
    WriteRunFolder(RunScenario(scenario), out(name));
    return ReadFile(out(name) / "kinematic.csv");
  };
  const std::string first =
      run(Read("playback_lane_change", {"drive.plants=[kinematic]", "expect={}"}), "first");
  EXPECT_EQ(run(ReadScenario(out("first") / run_folder::kScenarioYaml), "again"), first);
  EXPECT_EQ(ReadFile(out("first") / "recording.csv"), ReadFile(out("again") / "recording.csv"));
}

TEST(RunFolder, RepeatsThePathOfAFileFromItsOwnPoints) {
  const TempFolder folder;
  const auto out = [&](const char* name) { return folder.path() / name; };
  const auto run = [&](const Scenario& scenario, const char* name) {
    WriteRunFolder(RunScenario(scenario), out(name));
    return ReadFile(out(name) / "kinematic.csv");
  };
  const std::string first =
      run(Read("paths/from_a_file", {"drive.plants=[kinematic]", "plan.ahead=1", "expect={}"}),
          "first");
  EXPECT_EQ(run(ReadScenario(out("first") / run_folder::kScenarioYaml), "again"), first);
  for (const char* name : {"path.csv", "plan.csv", "plan.json", "scenario.resolved.yaml"}) {
    EXPECT_EQ(ReadFile(out("first") / name), ReadFile(out("again") / name)) << name;
  }
}

TEST(RunFolder, RepeatsARouteOnItsOwnRoads) {
  const TempFolder folder;
  const auto out = [&](const char* name) { return folder.path() / name; };
  const auto run = [&](const Scenario& scenario, const char* name) {
    WriteRunFolder(RunScenario(scenario), out(name));
    return ReadFile(out(name) / "kinematic.csv");
  };
  const std::string first =
      run(Read("roads/crossing", {"drive.plants=[kinematic]", "expect={}"}), "first");
  EXPECT_EQ(run(ReadScenario(out("first") / run_folder::kScenarioYaml), "again"), first);
  EXPECT_EQ(ReadFile(out("first") / "road_network.xodr"),
            ReadFile(fs::path(TRACKBED_SOURCE_DIR) / "scenarios/roads/crossing.xodr"));
}

TEST(RunFolder, TellsWhosePlantAStateIs) {
  for (const PlantEntry& plant : Plants()) {
    EXPECT_EQ(run_folder::PlantOfStateCsv(run_folder::StateCsv(plant.name)), plant.name);
  }
  EXPECT_EQ(run_folder::PlantOfStateCsv("mujoco-contact.state.csv"), "mujoco:contact");
  EXPECT_EQ(run_folder::PlantOfStateCsv("of_a_plugin.state.csv"), "of_a_plugin");
  for (const char* other : {"kinematic.csv", ".state.csv", ".kinematic.state.csv", "state.csv"}) {
    EXPECT_EQ(run_folder::PlantOfStateCsv(other), std::nullopt) << other;
  }
}

TEST(RunFolder, RequiresFilesByName) {
  const TempFolder folder;
  const fs::path file = folder.Write("plan.csv", "");
  EXPECT_EQ(run_folder::RequireFile(file), file);
  const fs::path missing = folder.path() / "plan.json";
  try {
    run_folder::RequireFile(missing);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), missing.string() + ": missing from the run folder");
  }
  try {
    run_folder::RequireFile(folder.path());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), folder.path().string() + ": is a folder, not a file");
  }
}

// A file that a run writes and the list lacks would survive the next run into the folder.
TEST(RunFolder, ListsWhateverARunAndItsComparisonWrite) {
  const TempFolder folder;
  // This run contains searched turns and a replan.
  const RunResult run =
      RunScenario(Read("obstacle_appears", {"plan.global={method: fillet, objective: turn_local}",
                                            "drive.time_limit=25", "expect={}"}));
  ASSERT_TRUE(run.plan.ok()) << run.plan->reason;
  WriteRunFolder(run, folder.path(), {.mcap = true});
  WriteComparison(CompareRun(run, std::nullopt), folder.path());
  const std::vector<std::string> names = folder.Names();
  EXPECT_THAT(names, testing::IsSupersetOf({"run.mcap", "kinematic.plan.csv", "mujoco.plan.json",
                                            "convergence.csv", "compare.csv", "schedule.csv"}));
  EXPECT_THAT(run_folder::AllNames(), testing::IsSupersetOf(names));
}

TEST(RunFolder, LosesEveryFileOfAnEarlierRun) {
  const TempFolder folder;
  nlohmann::json files;
  for (const std::string& name : run_folder::AllNames()) {
    folder.Write(name, "of an earlier run");
    files[name] = {{"bytes", 17}, {"sha256", ""}};
  }
  folder.Write("manifest.json", nlohmann::json{{"results", {{"run", files}}}}.dump());
  folder.Write("notes.txt", "mine");
  WriteRunFolder(RunScenario(Read("steering_circle",
                                  {"drive.plants=[kinematic]", "expect={}", "mission.duration=1"})),
                 folder.path());
  EXPECT_THAT(folder.Names(),
              testing::UnorderedElementsAre("scenario.resolved.yaml", "model.xml", "kinematic.csv",
                                            "kinematic.state.csv", "timing.json", "metrics.json",
                                            "manifest.json", "notes.txt"));
}

}  // namespace
}  // namespace trackbed
