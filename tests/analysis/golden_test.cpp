#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/analysis/run.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/file.h"
#include "trackbed/core/text_table.h"
#include "trackbed/scenario/scenario_files.h"

namespace trackbed {
namespace golden_test {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kScenarios = fs::path(TRACKBED_SOURCE_DIR) / "scenarios";
const fs::path kGolden = fs::path(TRACKBED_SOURCE_DIR) / "tests/data/golden/metrics";

/// File of the golden metrics of a scenario. A major version of MuJoCo that changes the metrics has
/// a separate file (docs/how-to/mujoco-versions.md).
fs::path GoldenFile(const std::string& scenario, const std::string& physics) {
  const std::string major = physics.substr(physics.find(' ') + 1, 1);  // of "MuJoCo 2.2.2"
  const fs::path own = kGolden.string() + "_mujoco_" + major + "/" + scenario + ".csv";
  return fs::exists(own) ? own : kGolden / (scenario + ".csv");
}

/// Returns the path of a file inside `folder`, without extension: "maneuvers/gust".
std::string NameIn(const fs::path& folder, const fs::path& file) {
  return file.lexically_relative(folder).replace_extension().string();
}

/// Returns the names of the scenarios that have golden metrics. Each test of this program calls
/// GoldenNames() at its start. GoldenNames() therefore reads no file.
std::vector<std::string> GoldenNames() {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(kGolden)) {
    if (entry.path().extension() == ".csv") {
      names.push_back(NameIn(kGolden, entry.path()));
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

class Golden : public testing::TestWithParam<std::string> {};

// Each metric has a measured tolerance; scripts/golden and docs/reproducibility.md describe the
// measurement.
TEST_P(Golden, MetricsAreWithinTheirTolerances) {
  const TempFolder folder;
  WriteRunFolder(RunScenario(ReadScenario(kScenarios / (GetParam() + ".yaml"))), folder.path());
  const json metrics = json::parse(ReadFile(folder.path() / run_folder::kMetricsJson));
  const TextTable golden =
      ReadTextCsv(GoldenFile(GetParam(), metrics.at("versions").at("physics").get<std::string>()));
  ASSERT_EQ(golden.columns(), (std::vector<std::string>{"metric", "value", "tolerance"}));
  std::vector<std::string> plants;
  for (const std::vector<std::string>& row : golden.rows()) {
    const json::json_pointer metric(row[0]);
    ASSERT_TRUE(metrics.contains(metric)) << row[0];
    const json& value = metrics.at(metric);
    if (row[2].empty()) {
      EXPECT_EQ(value.is_string() ? value.get<std::string>() : value.dump(), row[1]) << row[0];
    } else {
      EXPECT_NEAR(value.get<double>(), std::stod(row[1]), Tolerance(std::stod(row[2]))) << row[0];
    }
    if (metric.back() == "status") {
      plants.push_back(metric.parent_pointer().back());
    }
  }
  for (const auto& [plant, entry] : metrics.at("plants").items()) {
    EXPECT_THAT(plants, testing::Contains(plant));
  }
}

std::string TestName(const testing::TestParamInfo<std::string>& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Scenarios, Golden, testing::ValuesIn(GoldenNames()), TestName);

TEST(GoldenMetrics, AreThereForEveryScenario) {
  std::vector<std::string> scenarios;
  for (const fs::path& file : ScenarioFiles({kScenarios.string()}, FolderContent::kScenarios)) {
    if (file.lexically_relative(kScenarios).begin()->string() != "studies") {
      scenarios.push_back(NameIn(kScenarios, file));
    }
  }
  EXPECT_THAT(GoldenNames(), testing::UnorderedElementsAreArray(scenarios))
      << "scripts/golden makes them";
}

}  // namespace golden_test
}  // namespace trackbed
