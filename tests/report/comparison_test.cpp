#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/report/run_folders.h"
#include "tests/support/error_text.h"
#include "trackbed/analysis/compare_runs.h"
#include "trackbed/report/report.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using testing::EndsWith;
using testing::HasSubstr;

const std::string kPlants = "drive: {plants: [kinematic, single_track]}\n";

/// Copies a run, with one plant moved to the left of x by `shift` [m] and turned to the left by
/// `turn` [rad].
fs::path Shifted(const fs::path& run, const std::string& name, const std::string& plant,
                 double shift, double turn) {
  const fs::path copy = run.parent_path() / name;
  fs::create_directories(copy);
  fs::copy(run, copy, fs::copy_options::recursive);
  const fs::path file = copy / (plant + ".csv");
  const Table log = ReadCsv(file);
  Table other(log.columns());
  for (std::size_t row = 0; row < log.rows(); ++row) {
    std::vector<double> cells;
    for (std::size_t column = 0; column < log.columns().size(); ++column) {
      cells.push_back(log.at(row, column));
    }
    cells[static_cast<std::size_t>(log.Find("y_m"))] += shift;
    cells[static_cast<std::size_t>(log.Find("yaw_rad"))] += turn;
    other.AddRow(cells);
  }
  WriteFileAtomically(file, other.ToCsv());
  return copy;
}

ordered_json PairNumber(const ordered_json& pair, const std::string& path) {
  for (const ordered_json& number : pair["numbers"]) {
    if (number["path"] == path) {
      return number["value"];
    }
  }
  return nullptr;
}

/// The compared pairs, such as "0 single_track - 1 single_track".
std::vector<std::string> PairsIn(const ordered_json& data) {
  std::vector<std::string> pairs;
  for (const ordered_json& pair : data["comparison"]["pairs"]) {
    pairs.push_back(fmt::format(
        "{} {} - {} {}", pair["first"]["run"].get<int>(), pair["first"]["plant"].get<std::string>(),
        pair["second"]["run"].get<int>(), pair["second"]["plant"].get<std::string>()));
  }
  return pairs;
}

std::string ErrorMessage(const std::vector<fs::path>& paths) {
  return ErrorText([&] { ReportData(paths); });
}

TEST(Comparison, HoldsEachPlantOfTheFirstRunAgainstItsNamesakes) {
  const TempFolder folder;
  const fs::path a = DriveCorner(folder, "a", kPlants);
  const fs::path b = Shifted(a, "b", "single_track", 0.25, -0.125);
  const fs::path c = Shifted(a, "c", "kinematic", -2.0, 0.0);
  const ordered_json data = ReportData({a, b, c});
  EXPECT_THAT(PairsIn(data),
              testing::ElementsAre("0 kinematic - 1 kinematic", "0 single_track - 1 single_track",
                                   "0 kinematic - 2 kinematic", "0 single_track - 2 single_track"));
  EXPECT_TRUE(data["comparison"]["verdicts"].empty());
  const auto& pairs = data["comparison"]["pairs"];
  // The copies differ only by shifts and turns, so the results are exact except for rounding.
  constexpr double kExact = 1e-6;
  EXPECT_NEAR(PairNumber(pairs[0], "position.max").get<double>(), 0.0, kExact);
  EXPECT_NEAR(PairNumber(pairs[1], "position.max").get<double>(), 0.25, kExact);
  EXPECT_NEAR(PairNumber(pairs[1], "position.rms").get<double>(), 0.25, kExact);
  EXPECT_NEAR(PairNumber(pairs[1], "heading.max").get<double>(), 0.125, kExact);
  EXPECT_NEAR(PairNumber(pairs[1], "steering.max").get<double>(), 0.0, kExact);
  EXPECT_NEAR(PairNumber(pairs[2], "position.max").get<double>(), 2.0, kExact);
  EXPECT_NEAR(PairNumber(pairs[3], "position.max").get<double>(), 0.0, kExact);
  const ordered_json& curve = pairs[1]["curve"];
  const std::vector<double> stations = ReadCsv(a / "single_track.csv").Column("s_m");
  EXPECT_NEAR(curve["s"].front().get<double>(), stations.front(), kExact);
  EXPECT_NEAR(curve["s"].back().get<double>(), stations.back(), 1e-4);  // six digits of 30 m
  ASSERT_EQ(curve["s"].size(), curve["position"].size());
  for (std::size_t i = 0; i < curve["s"].size(); ++i) {
    ASSERT_NEAR(curve["position"][i].get<double>(), 0.25, kExact);
    ASSERT_NEAR(curve["heading"][i].get<double>(), -0.125, kExact);  // second relative to first
    ASSERT_NEAR(curve["yaw_rate"][i].get<double>(), 0.0, kExact);
    ASSERT_NEAR(curve["steering"][i].get<double>(), 0.0, kExact);
  }
}

TEST(Comparison, ShowsWhatAComparisonFound) {
  const TempFolder folder;
  const fs::path a = DriveCorner(folder, "a", kPlants);
  const fs::path b = Shifted(a, "b", "single_track", 0.25, 0.0);
  const fs::path out = folder.path() / "out";
  WriteComparison(
      CompareFolders({a, b}, {}, DifferenceBounds{.position_max = 0.125, .heading_max = 1.0}), out);
  const ordered_json data = ReportData({out});
  EXPECT_EQ(data["runs"][0]["name"], "a");
  EXPECT_EQ(data["runs"][1]["name"], "b");
  EXPECT_THAT(PairsIn(data),
              testing::ElementsAre("0 kinematic - 1 kinematic", "0 single_track - 1 single_track"));
  const ordered_json& comparison = data["comparison"];
  ASSERT_EQ(comparison["verdicts"].size(), 1U);
  EXPECT_EQ(comparison["verdicts"][0]["passed"], false);
  ASSERT_EQ(comparison["verdicts"][0]["failures"].size(), 1U);
  EXPECT_THAT(comparison["verdicts"][0]["failures"][0].get<std::string>(),
              HasSubstr("position difference 0.25 m exceeds 0.125 m"));
  EXPECT_EQ(comparison["pairs"][1]["tolerances"].dump(),
            R"({"position_max":0.125,"heading_max":1.0})");
  // With two different plants, only that pair is compared.
  WriteComparison(CompareFolders({a, b}, {"kinematic", "single_track"}, std::nullopt), out);
  const ordered_json mixed = ReportData({out});
  EXPECT_THAT(PairsIn(mixed), testing::ElementsAre("0 kinematic - 1 single_track"));
  // Without tolerances there is no verdict.
  EXPECT_TRUE(mixed["comparison"]["verdicts"][0]["passed"].is_null());
}

TEST(Comparison, OfOneRunStandsWithThatRun) {
  const TempFolder folder;
  const fs::path a = DriveCorner(folder, "a", kPlants);
  const fs::path b = Shifted(a, "b", "single_track", 0.25, 0.0);
  // The plants of this run are compared even without a judged comparison.
  const ordered_json alone = ReportData({a});
  EXPECT_THAT(PairsIn(alone), testing::ElementsAre("0 kinematic - 0 single_track"));
  EXPECT_TRUE(alone["comparison"]["verdicts"].empty());
  RememberHashes(a);
  for (const fs::path& out : {folder.path() / "out", a}) {
    WriteComparison(CompareFolders({a}, {}, DifferenceBounds{.position_max = 100.0}), out);
    const ordered_json data = ReportData({out});
    EXPECT_EQ(data["runs"].size(), 1U);
    EXPECT_THAT(PairsIn(data), testing::ElementsAre("0 kinematic - 0 single_track"));
    EXPECT_EQ(data["comparison"]["verdicts"][0]["passed"], true);
  }
  // compare.json as `compare` writes it into the folder of the run that it made.
  ordered_json json = ordered_json::parse(ReadFile(a / "compare.json"));
  json.erase("runs");
  ForgetHashes(a);
  folder.Write("a/compare.json", json.dump());
  EXPECT_EQ(ReportData({a})["comparison"]["verdicts"].size(), 1U);
  const ordered_json both = ReportData({b, a});
  EXPECT_THAT(PairsIn(both),
              testing::ElementsAre("1 kinematic - 1 single_track", "0 kinematic - 1 kinematic",
                                   "0 single_track - 1 single_track"));
  EXPECT_EQ(both["comparison"]["verdicts"][0]["run"], 1);
  // A comparison of other runs must not be shown for these two runs.
  RememberHashes(b);
  WriteComparison(CompareFolders({a, b}, {}, std::nullopt), b);
  EXPECT_EQ(ReportData({b, a})["comparison"]["verdicts"].size(), 1U);
}

TEST(Comparison, SaysWhatIsWrong) {
  const TempFolder folder;
  const fs::path a = DriveCorner(folder, "a", kPlants);
  const fs::path b = Shifted(a, "b", "single_track", 0.25, 0.0);
  const fs::path out = folder.path() / "out";
  WriteComparison(CompareFolders({a, b}, {}, std::nullopt), out);
  const std::string text = ReadFile(out / "compare.json");
  ForgetHashes(out);
  EXPECT_EQ(ErrorMessage({out, a}), out.string() + ": a comparison must be given alone");
  folder.Write("out/compare.json", "{\"pairs\": ");
  EXPECT_THAT(ErrorMessage({out}), HasSubstr("compare.json:1:11: not JSON"));
  folder.Write("out/compare.json", "{\"pairs\": []}");
  EXPECT_THAT(ErrorMessage({out}),
              EndsWith("compare.json: does not name its runs; compare the runs again"));
  folder.Write("out/compare.json", text);
  EXPECT_EQ(ErrorMessage({out}), "");
  // A different run has the same name.
  fs::remove_all(b);
  Shifted(a, "b", "single_track", 0.5, 0.0);
  EXPECT_THAT(ErrorMessage({out}),
              testing::MatchesRegex(
                  ".*compare.json: position.max is 0.2.*, but the logs .*a/single_track.csv "
                  "and .*b/single_track.csv give 0.5.*; compare the runs again"));
  fs::remove_all(b);
  DriveCorner(folder, "b", "drive: {plants: [kinematic]}\n");
  EXPECT_THAT(ErrorMessage({out}), EndsWith("compare.json: of single_track, which is not in " +
                                            b.string() + "; compare the runs again"));
  fs::remove_all(b);
  EXPECT_EQ(ErrorMessage({out}), out.string() + ": the compared run in " + b.string() +
                                     " does not exist (no metrics.json)");
}

TEST(Comparison, CallsRunsOfOneNameAfterTheirParents) {
  const TempFolder folder;
  fs::create_directories(folder.path() / "old");
  fs::create_directories(folder.path() / "new");
  const std::string plant = "drive: {plants: [kinematic], time_limit: 1}\n";
  const fs::path a = DriveCorner(folder, "old/corner", plant);
  const fs::path b = DriveCorner(folder, "new/corner", plant);
  const ordered_json data = ReportData({a, b});
  EXPECT_EQ(data["runs"][0]["name"], "old/corner");
  EXPECT_EQ(data["runs"][1]["name"], "new/corner");
}

}  // namespace
}  // namespace trackbed
