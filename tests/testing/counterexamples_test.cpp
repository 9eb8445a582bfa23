#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <ostream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "trackbed/testing/scenario_testing.h"

/// Tests the counterexamples of docs/limits.md.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(TRACKBED_SOURCE_DIR) / "tests/data/counterexamples";

/// A row of a table on the page, without settings if the failure is fixed.
struct LimitRow {
  std::string name;
  std::vector<Override> fails_at;
  std::vector<Override> holds_up_to;
};

void PrintTo(const LimitRow& row, std::ostream* out) {
  *out << row.name;
}

/// A rolling start has the speed of the mission, which the files state twice.
std::vector<Override> WithStart(const Override& setting) {
  const std::string speed = "mission.speed=";
  if (setting.compare(0, speed.size(), speed) == 0) {
    return {setting, "mission.start.speed=" + setting.substr(speed.size())};
  }
  return {setting};
}

std::vector<MetricValue> ValuesOf(const RunResult& run) {
  std::vector<MetricValue> values;
  for (const Check& check : run.verdict.checks) {
    values.push_back(check.value);
  }
  return values;
}

/// Parses "`a=1`, `b=2`" into settings.
std::vector<Override> SettingsOf(const std::string& cell) {
  std::vector<Override> settings;
  const std::regex quoted("`([^`]*=[^`]*)`");
  for (std::sregex_iterator it(cell.begin(), cell.end(), quoted), end; it != end; ++it) {
    settings.emplace_back((*it)[1].str());
  }
  return settings;
}

std::vector<LimitRow> Rows() {
  std::vector<LimitRow> rows;
  std::ifstream page(fs::path(TRACKBED_SOURCE_DIR) / "docs/limits.md");
  const std::regex row(R"(\| \[(\w+)\]\([^)]*/(\w+)\.yaml\) \|([^|]*)\|([^|]*)\|.*)");
  for (std::string line; std::getline(page, line);) {
    std::smatch found;
    if (std::regex_match(line, found, row) && found[1] == found[2]) {
      rows.push_back({found[1], SettingsOf(found[3]), SettingsOf(found[4])});
    }
  }
  return rows;
}

TEST(Counterexamples, AreAllOnThePageOfLimits) {
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    files.insert(entry.path().stem().string());
  }
  std::set<std::string> rows;
  for (const LimitRow& row : Rows()) {
    rows.insert(row.name);
  }
  EXPECT_EQ(rows, files);
  EXPECT_GE(files.size(), 10U);
}

class KnownLimit : public testing::TestWithParam<LimitRow> {};

/// Fixed failures must stay fixed. Listed failures must occur at the stated value and not at the
/// nearby values of the table.
TEST_P(KnownLimit, IsWhereThePageSays) {
  const LimitRow& row = GetParam();
  const fs::path file = kFolder / (row.name + ".yaml");
  const RunResult run = RunScenario(file);
  EXPECT_EQ(run.scenario.name, row.name);
  EXPECT_TRUE(run.verdict.passed) << testing::PrintToString(run.verdict.failures);
  if (!row.fails_at.empty()) {
    EXPECT_EQ(ValuesOf(RunScenario(file, row.fails_at)), ValuesOf(run));
    EXPECT_FALSE(row.holds_up_to.empty());
  }
  for (const Override& nearer : row.holds_up_to) {
    // The expectations of the file describe its failure, so a run without this failure does not
    // pass.
    EXPECT_FALSE(RunScenario(file, WithStart(nearer)).verdict.passed)
        << testing::PrintToString(nearer);
  }
}

INSTANTIATE_TEST_SUITE_P(Docs, KnownLimit, testing::ValuesIn(Rows()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace trackbed
