// Tests the data and the HTML page of reports of runs and studies: numbers against the files of the
// run folder, statistics against closed forms, size and Content-Security-Policy.

#include "trackbed/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/report/run_folders.h"
#include "tests/support/error_text.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using testing::EndsWith;
using testing::HasSubstr;

/// The data embedded in the page.
ordered_json DataIn(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(begin) + begin.size();
  return ordered_json::parse(page.substr(from, page.find("</script>", from) - from));
}

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) {
    ++count;
  }
  return count;
}

/// The page with empty script and style elements.
std::string Markup(std::string page) {
  for (const char* name : {"script", "style"}) {
    const std::string open = std::string("<") + name;
    const std::string close = std::string("</") + name + ">";
    for (std::size_t at = 0; (at = page.find(open, at)) != std::string::npos;) {
      const std::size_t from = page.find('>', at) + 1;
      page.erase(from, page.find(close, from) - from);
      at = from;
    }
  }
  return page;
}

TEST(ReportData, HoldsTheLogsOfTheRun) {
  const TempFolder folder;
  const fs::path run = DriveCorner(folder, "run",
                                   "world: {obstacles: [{box: {x: 5, y: 9, yaw: 0.5, length: 3, "
                                   "width: 1}, velocity: {x: 1}}]}\n");
  const ordered_json data = ReportData({run})["runs"][0];
  const std::vector<std::pair<const char*, const char*>> channels{
      {"t", "t_s"},
      {"x", "x_m"},
      {"y", "y_m"},
      {"yaw", "yaw_rad"},
      {"speed", "speed_mps"},
      {"steering_command", "steering_command_rad"},
      {"steering", "steering_rad"},
      {"yaw_rate", "yaw_rate_radps"},
      {"lateral_acceleration", "lateral_acceleration_mps2"},
      {"cross_track", "cross_track_m"},
      {"heading_error", "heading_error_rad"},
      {"sideslip", "sideslip_rad"},
      {"longitudinal_acceleration", "longitudinal_acceleration_mps2"},
      {"clearance", "clearance_m"}};
  ASSERT_EQ(data["plants"].size(), 2U);
  for (const ordered_json& plant : data["plants"]) {
    const Table csv = ReadCsv(run / (plant["name"].get<std::string>() + ".csv"));
    ASSERT_EQ(plant["log"].size(), channels.size());
    for (const auto& [name, column] : channels) {
      const std::vector<double> values = csv.Column(column);
      const ordered_json& shown = plant["log"][name];
      ASSERT_EQ(shown.size(), values.size()) << name;
      for (std::size_t i = 0; i < values.size(); ++i) {
        // The tolerance is half a unit of the sixth digit, or the threshold below which values are
        // shown as zero.
        ASSERT_NEAR(shown[i].get<double>(), values[i], std::max(5e-6 * std::abs(values[i]), 5e-7))
            << name << " of row " << i;
      }
    }
  }
  const Table plan = ReadCsv(run / "plan.csv");
  ASSERT_EQ(data["plan"]["line"]["x"].size(), plan.rows());
  // The corner is at (20, 20): six digits are a tenth of a millimeter.
  EXPECT_NEAR(data["plan"]["line"]["y"].back().get<double>(), plan.Column("y_m").back(), 1e-4);
  EXPECT_EQ(
      data["world"]["obstacles"].dump(),
      R"([{"x":5.0,"y":9.0,"yaw":0.5,"length":3.0,"width":1.0,"vx":1.0,"vy":0.0,"height":1.0,)"
      R"("known_later":false}])");
  // The Prius, from the model in the run folder.
  EXPECT_EQ(data["car"]["length"], 4.45);
  EXPECT_EQ(data["car"]["width"], 1.725);
  EXPECT_EQ(data["resolved"], ReadFile(run / "scenario.resolved.yaml"));
}

TEST(ReportData, NamesEveryNumberOfADrive) {
  const TempFolder folder;
  const fs::path run = DriveCorner(
      folder, "run", "world: {obstacles: [{box: {x: 5, y: 9, length: 3, width: 1}}]}\n");
  const ordered_json data = ReportData({run})["runs"][0];
  const ordered_json metrics = ordered_json::parse(ReadFile(run / "metrics.json"));
  for (const ordered_json& plant : data["plants"]) {
    const std::string name = plant["name"];
    for (const ordered_json& number : plant["numbers"]) {
      EXPECT_NE(number["label"], number["path"]);
      if (number["path"] == "cross_track.max") {
        const double exact = metrics["plants"][name]["cross_track"]["max"];
        EXPECT_NEAR(number["value"].get<double>(), exact, 5e-6 * exact);
      }
    }
  }
  for (const ordered_json& number : data["between"][0]["numbers"]) {
    EXPECT_NE(number["label"], number["path"]);
  }
}

TEST(ReportData, FindsUnmetWhatTheVerdictFinds) {
  const TempFolder folder;
  const fs::path run = DriveCorner(
      folder, "run",
      "world: {obstacles: [{box: {x: 5, y: 9, length: 3, width: 1}}]}\n"
      "expect:\n"
      "  reach_goal: 0.5\n"
      "  max_cross_track: 1.0e-9\n"
      "  rms_cross_track: 1.0e-9\n"
      "  max_heading_error: 1\n"
      "  min_clearance: 100\n"
      "  collision: true\n"
      "  mujoco:\n"
      "    reach_goal: 1.0e-9\n"
      "    metrics:\n"
      "      - {metric: distance, min: 1, max: 2}\n"
      "      - {metric: plan_changes, equals: 1}\n"
      "      - {metric: status, equals: arrived}\n"
      "  between: [{plants: [mujoco, kinematic], position_max: 1.0e-9, heading_max: 1}]\n");
  const ordered_json data = ReportData({run})["runs"][0];
  std::vector<std::string> unmet;
  for (const ordered_json& row : data["expectations"]) {
    if (!row["met"]) {
      unmet.push_back(row["of"].get<std::string>() + ": " + row["what"].get<std::string>() + " " +
                      row["asked"].get<std::string>());
    }
  }
  EXPECT_EQ(unmet.size(), data["verdict"]["failures"].size());
  EXPECT_THAT(unmet,
              testing::UnorderedElementsAre(
                  "kinematic: Maximum cross-track error ≤ 1e-09",
                  "kinematic: Cross-track error, rms ≤ 1e-09", "kinematic: Minimum clearance ≥ 100",
                  "kinematic: Collision = true", "mujoco: Maximum cross-track error ≤ 1e-09",
                  "mujoco: Cross-track error, rms ≤ 1e-09", "mujoco: Minimum clearance ≥ 100",
                  "mujoco: Collision = true", "mujoco: Distance to the goal ≤ 1e-09",
                  "mujoco: Distance traveled ≤ 2", "mujoco: Replans = 1",
                  "kinematic – mujoco: Maximum distance ≤ 1e-09"));
  // The list has 26 entries: every bound, the arrival of plants without an expected end, and the
  // limits of steering rate, overspeed and oscillation.
  EXPECT_EQ(data["expectations"].size(), 26U);
  EXPECT_FALSE(data["verdict"].contains("checks"));
}

TEST(ReportData, OpensARunWithoutChecks) {
  const TempFolder folder;
  const fs::path run = DriveCorner(folder, "run", "drive: {plants: [kinematic]}\n");
  ordered_json metrics = ordered_json::parse(ReadFile(run / "metrics.json"));
  metrics["verdict"].erase("checks");
  metrics["verdict"]["failures"] = {"kinematic: as it was"};
  WriteFileAtomically(run / "metrics.json", metrics.dump());
  const ordered_json data = ReportData({run})["runs"][0];
  EXPECT_TRUE(data["expectations"].empty());
  EXPECT_EQ(data["verdict"]["failures"][0], "kinematic: as it was");
}

TEST(ReportData, RefusesFilesOfTwoRuns) {
  const TempFolder folder;
  const auto run = [&](const std::string& speed) {
    WriteRunFolder(
        RunScenario(ParseScenario("schema: 1\nname: s\nmission: {speed: " + speed +
                                      ", waypoints: [[0, 0], [20, 0], [20, 20]]}\nplan: {method: "
                                      "fillet}\ndrive: {plants: [kinematic]}\n",
                                  "s.yaml", ".")),
        folder.path() / speed);
    return folder.path() / speed;
  };
  const fs::path first = run("3");
  const fs::path second = run("4");
  EXPECT_NO_THROW(ReportData({first}));
  fs::copy_file(second / "plan.csv", first / "plan.csv", fs::copy_options::overwrite_existing);
  try {
    ReportData({first});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("plan.csv: does not belong to this run"));
  }
}

TEST(ReportData, TakesChecksAsTheyAre) {
  const TempFolder folder;
  const fs::path run = DriveCorner(folder, "run", "drive: {plants: [kinematic]}\n");
  ordered_json metrics = ordered_json::parse(ReadFile(run / "metrics.json"));
  metrics["verdict"]["checks"] = ordered_json::parse(
      R"([{"plant": "kinematic", "metric": "lateral_acceleration_max", "relation": "at_most",
           "bound": 0.155087500001, "value": 0.12345678, "station": 1, "time": 2, "met": false}])");
  WriteFileAtomically(run / "metrics.json", metrics.dump());
  EXPECT_EQ(ReportData({run})["runs"][0]["expectations"].dump(),
            R"json([{"of":"kinematic","metric":"lateral_acceleration_max",)json"
            R"json("what":"Maximum lateral acceleration (0.1 s mean)","unit":"m/s²",)json"
            R"json("relation":"at_most","bound":0.155088,"asked":"≤ 0.155088",)json"
            R"json("found":0.123457,"t":2,"met":false}])json");
}

TEST(ReportData, ShowsAMissionWithoutAPlan) {
  const TempFolder folder;
  const fs::path run = DriveCorner(folder, "run", "");
  const fs::path none = folder.path() / "none";
  WriteRunFolder(RunScenario(ParseScenario(
                     "schema: 1\nname: none\nmission: {speed: 3, waypoints: [[0, 0], [10, "
                     "0], [10, 10]]}\nplan: {method: fillet}\n",
                     "none.yaml", ".")),
                 none);
  const ordered_json data = ReportData({none});
  EXPECT_TRUE(data["runs"][0]["plants"].empty());
  EXPECT_EQ(data["runs"][0]["plan"]["status"], "turn_too_tight");
  EXPECT_FALSE(data["runs"][0]["verdict"]["passed"]);
  EXPECT_EQ(ReportData({none, run})["runs"].size(), 2U);
}

TEST(ReportData, SaysWhatIsWrong) {
  const TempFolder folder;
  const fs::path run = DriveCorner(folder, "run", "drive: {plants: [kinematic]}\n");
  const auto error = [&](const std::vector<fs::path>& paths) {
    return ErrorText([&] { ReportData(paths); });
  };
  EXPECT_THAT(error({folder.path() / "gone"}), EndsWith("gone: no such folder"));
  EXPECT_THAT(error({folder.path()}),
              HasSubstr("not a finished run (no metrics.json), a comparison"));
  EXPECT_THAT(error({run / "metrics.json"}), HasSubstr("not a finished run"));
  EXPECT_THAT(error({run, folder.path() / "run/../run"}), HasSubstr("given twice"));
  const fs::path study = folder.Write("study/sweep.csv", "seed,status\n1,passed\n");
  EXPECT_THAT(error({run, study}), HasSubstr("a study must be given alone"));
  const auto broken = [&](const std::string& name, const std::string& text) {
    const fs::path copy = folder.path() / "copy";
    fs::remove_all(copy);
    fs::copy(run, copy);
    fs::remove(copy / name);
    if (!text.empty()) {
      folder.Write("copy/" + name, text);
    }
    return error({copy});
  };
  EXPECT_THAT(broken("kinematic.csv", ""), EndsWith("kinematic.csv: missing from the run folder"));
  EXPECT_THAT(broken("kinematic.csv", "t_s,x_m\n0,a\n"), HasSubstr("no column 'y_m'"));
  const std::string header = "t_s,x_m,y_m,yaw_rad,speed_mps,steering_command_rad,steering_rad\n";
  EXPECT_THAT(broken("kinematic.csv", header + "0,0,0,0,0,0,0\n0,0,0,0,0,0,0\n"),
              EndsWith("kinematic.csv:3: t_s: 0 must be above the previous 0"));
  EXPECT_THAT(broken("kinematic.csv", header + "0,0,nan,0,0,0,0\n"),
              HasSubstr("kinematic.csv:2: cell 3 (y_m)"));
  EXPECT_THAT(broken("kinematic.csv", header), HasSubstr("kinematic.csv: no rows"));
  EXPECT_THAT(broken("metrics.json", "{\"plants\": "), HasSubstr("metrics.json:1:12: not JSON"));
  EXPECT_THAT(broken("metrics.json", "{}"), HasSubstr("metrics.json: "));
  EXPECT_THAT(broken("plan.json", "[1"), HasSubstr("plan.json:1:3: not JSON"));
  EXPECT_THAT(broken("plan.json", ""), EndsWith("plan.json: missing from the run folder"));
  EXPECT_THAT(broken("plan.csv", ""), EndsWith("plan.csv: missing from the run folder"));
  EXPECT_THAT(broken("scenario.resolved.yaml", ""), HasSubstr("missing from the run folder"));
  EXPECT_THAT(broken("model.xml", ""), HasSubstr("missing from the run folder"));
}

TEST(ReportData, RefusesWhatThePageCouldNotShow) {
  const TempFolder folder;
  const fs::path run = DriveCorner(folder, "run", "expect: {reach_goal: 0.5}\n");
  const ordered_json metrics = ordered_json::parse(ReadFile(run / "metrics.json"));
  for (const char* pointer :
       {"/scenario", "/complete", "/seed", "/versions", "/versions/physics", "/verdict/passed",
        "/verdict/failures", "/verdict/notes", "/verdict/checks/0/met", "/verdict/checks/0/plant",
        "/between/0/plants"}) {
    ordered_json odd = metrics;
    odd.at(ordered_json::json_pointer(pointer)) = {{"a", 1}};
    WriteFileAtomically(run / "metrics.json", odd.dump());
    EXPECT_THAT(ErrorText([&] { ReportData({run}); }), HasSubstr("metrics.json: ")) << pointer;
  }
}

TEST(ReportData, HoldsTheTableOfAStudy) {
  const TempFolder folder;
  const std::string csv =
      "mission.speed,drive.plants,seed,status,metrics.*.cross_track.max,verdict.failures\n"
      "2.5,\"[kinematic, mujoco]\",7,passed,0.0123456789,\n"
      "3,[mujoco],8,no_plan,,\"no plan (<b>&), \"\"x\"\"\"\n";
  folder.Write("study/sweep.csv", csv);
  const fs::path table = folder.Write("my table.csv", csv);
  const ordered_json study = ReportData({table})["study"];
  EXPECT_EQ(study["name"], "my table");
  const auto& columns = study["columns"];
  std::vector<std::string> kinds;
  for (const ordered_json& column : columns) {
    kinds.push_back(column["kind"]);
  }
  EXPECT_THAT(kinds,
              testing::ElementsAre("parameter", "parameter", "seed", "status", "output", "output"));
  EXPECT_EQ(columns[0]["unit"], "m/s");
  EXPECT_EQ(columns[4]["label"], "Maximum cross-track error");
  EXPECT_EQ(study["rows"].dump(),
            R"([[2.5,"[kinematic, mujoco]",7.0,"passed",0.0123457,null],)"
            R"([3.0,"[mujoco]",8.0,"no_plan",null,"no plan (<b>&), \"x\""]])");
  // In the folder of a sweep, its sweep.json provides more data.
  EXPECT_EQ(ReportData({folder.path() / "study"})["study"]["name"], "sweep");
  folder.Write("study/sweep.json",
               R"({"study": "fast", "scenario": "a.yaml", "complete": false, "rows_expected": 3,)"
               R"( "versions": {}})");
  EXPECT_EQ(ReportData({folder.path() / "study"})["study"]["name"], "fast");
  EXPECT_EQ(ReportData({folder.path() / "study"})["study"]["complete"], false);
  folder.Write("study/sweep.json", "{}");
  EXPECT_THAT(ErrorText([&] { ReportData({folder.path() / "study"}); }), HasSubstr("sweep.json: "));
  EXPECT_THAT(ErrorText([&] { ReportData({folder.Write("other.csv", "a,b\n1,2\n")}); }),
              HasSubstr("other.csv:1: no column 'status'"));
}

/// A study of `rows` rows in which two controllers alternate. The output is x with the first
/// controller and 2 x with the second controller. A row passes if its output is below 1.
std::string BigStudy(int rows) {
  std::string csv = "control,x,status,y,reason\n";
  for (int i = 0; i < rows; ++i) {
    const double x = (i / 2 + 0.5) / (rows / 2);
    const double y = i % 2 == 0 ? x : 2.0 * x;
    csv += fmt::format("{},{},{},{},\n", i % 2 == 0 ? "lqr" : "mpc", x,
                       y < 1.0 ? "passed" : "failed", y);
  }
  return csv;
}

// y = x k with x uniform in (0, 1) and k 1 or 2: the mean is 3/4, the variance E[x^2] E[k^2] - 9/16
// = 5/6 - 9/16 = 13/48. E[y | k] = k / 2 has a variance of 1/16, and E[y | x] = 3 x / 2 has a
// variance of 9/4 / 12 = 3/16. The shares of the variance are 3/13 and 9/13.
TEST(StudyData, SaysWhatAllRowsSayTogether) {
  const TempFolder folder;
  const ordered_json study = ReportData({folder.Write("study.csv", BigStudy(2000))})["study"];
  const ordered_json& all = study["statistics"];
  EXPECT_EQ(all["rows"], 2000);
  EXPECT_EQ(all["pass_rate"], 0.75);
  // The normal approximation of the interval is 0.75 +- 1.96 sqrt(0.75 / 4 / 2000). Wilson's
  // interval is 0.0005 nearer to a half.
  EXPECT_NEAR(all["pass_interval"][0].get<double>(), 0.75 - 0.019, 1e-3);
  EXPECT_NEAR(all["pass_interval"][1].get<double>(), 0.75 + 0.019, 1e-3);
  ASSERT_EQ(all["outputs"].size(), 2U);
  const ordered_json& y = all["outputs"][0];
  EXPECT_EQ(y["name"], "y");
  // The median is 2/3, because y < 2/3 means x < 2/3 for one controller and x < 1/3 for the other.
  // The values are 0.002 apart.
  EXPECT_EQ(y["quantiles"][4][0], 0.5);
  EXPECT_NEAR(y["quantiles"][4][1].get<double>(), 2.0 / 3.0, 0.002);
  EXPECT_EQ(y["distribution"].size(), 200U);
  ASSERT_EQ(y["indices"].size(), 2U);
  // Evenly spaced values have no random error, but the index subtracts the bias that random values
  // would have. Evenly spaced values have no random error, but the index subtracts the bias that
  // random values would cause.
  EXPECT_NEAR(y["indices"][0]["index"].get<double>(), 3.0 / 13.0, 0.03);
  EXPECT_NEAR(y["indices"][1]["index"].get<double>(), 9.0 / 13.0, 0.03);
  const ordered_json& means = y["effects"][0]["classes"];
  EXPECT_EQ(means[0]["value"], "lqr");
  EXPECT_NEAR(means[0]["mean"].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(means[1]["mean"].get<double>(), 1.0, 1e-9);
  EXPECT_EQ(y["effects"][1]["classes"].size(), 12U);
  const ordered_json& passed = all["outputs"][1];
  EXPECT_EQ(passed["name"], "passed");
  EXPECT_FALSE(passed.contains("quantiles"));
  EXPECT_EQ(passed["effects"][0]["classes"][0]["mean"], 1.0);
  EXPECT_EQ(passed["effects"][0]["classes"][1]["mean"], 0.5);
}

TEST(StudyData, OfABigStudyHasSomeRowsAndTheEndsOfOutputs) {
  const TempFolder folder;
  const ordered_json study = ReportData({folder.Write("study.csv", BigStudy(10000))})["study"];
  EXPECT_EQ(study["row_count"], 10000);
  EXPECT_EQ(study["passed_count"], 7500);
  EXPECT_EQ(study["even_count"], 4000);
  const auto numbers = study["row_numbers"].get<std::vector<int>>();
  EXPECT_EQ(numbers.size(), study["rows"].size());
  // The lowest values of `y` are in the first rows, and the highest values in the last odd rows.
  // The page must show these rows in addition to its evenly spaced rows, which are one in 2.5.
  for (const int row : {0, 1, 2, 3, 9999, 9997, 9995, 9981}) {
    EXPECT_NE(std::find(numbers.begin(), numbers.end(), row), numbers.end()) << row;
  }
  EXPECT_EQ(study["statistics"]["rows"], 10000);
}

TEST(StudyData, OfAFewRowsHasNoStatistics) {
  const TempFolder folder;
  EXPECT_TRUE(
      ReportData({folder.Write("study.csv", BigStudy(18))})["study"]["statistics"].is_null());
}

TEST(StudyDifference, IsOfRowsThatSetTheSame) {
  const TempFolder folder;
  const fs::path before = folder.Write("before/sweep.csv",
                                       "x,status,y,z,reason\n1,passed,1,7,\n2,failed,2,7,\n"
                                       "3,failed,3,7,\n4,passed,,7,\n9,passed,9,7,\n");
  // The second table has the rows in a different order, a different output, and no last row.
  const fs::path after = folder.Write("after/sweep.csv",
                                      "x,status,w,y,reason\n3,passed,0,5,\n2,passed,0,2,\n"
                                      "1,passed,0,4,\n4,failed,0,1,\n");
  const ordered_json study = ReportData({before.parent_path(), after.parent_path()})["study"];
  EXPECT_EQ(study["row_count"], 4);
  const ordered_json& difference = study["difference"];
  EXPECT_EQ(difference["before"], before.parent_path().string());
  EXPECT_EQ(difference["rows"], 4);
  EXPECT_EQ(difference["only_before"], 1);
  EXPECT_EQ(difference["only_after"], 0);
  ASSERT_EQ(difference["outputs"].size(), 2U);
  const ordered_json& passed = difference["outputs"][0];
  EXPECT_EQ(passed["name"], "passed");
  EXPECT_EQ(passed["before"], 0.5);
  EXPECT_EQ(passed["after"], 0.75);
  EXPECT_EQ(passed["higher"], 2);
  EXPECT_EQ(passed["lower"], 1);
  // A ratio of 2 : 1 or a more extreme ratio has the probability 1.
  EXPECT_EQ(passed["sign_test"], 1.0);
  const ordered_json& y = difference["outputs"][1];
  EXPECT_EQ(y["name"], "y");
  EXPECT_EQ(y["count"], 3);                               // the fourth row had no y
  EXPECT_NEAR(y["mean"].get<double>(), 5.0 / 3.0, 1e-5);  // six digits
  EXPECT_EQ(y["median"], 2.0);
  EXPECT_EQ(y["equal"], 1);
  EXPECT_EQ(y["sign_test"], 0.5);  // two of two
}

TEST(StudyDifference, NeedsTheSameKeysAndDistinctRows) {
  const TempFolder folder;
  const auto refusal = [&](const std::string& before, const std::string& after) {
    const std::vector<fs::path> files{folder.Write("a.csv", before), folder.Write("b.csv", after)};
    const std::string message = ErrorText([&] { ReportData(files); });
    return std::regex_replace(message, std::regex(folder.path().string() + "/"), "");
  };
  const std::string one = "x,status\n1,passed\n";
  EXPECT_EQ(refusal(one, "y,x,status\n1,1,passed\n"),
            "b.csv: varies other keys (y, x) than a.csv (x)");
  EXPECT_EQ(refusal(one, "x,status\n2,passed\n"),
            "b.csv: has no row that sets the same as one of a.csv");
  EXPECT_EQ(refusal("x,status\n1,passed\n1,failed\n", one),
            "a.csv:3: sets the same as an earlier row, so that it cannot be compared with one of "
            "another study");
}

TEST(ReportPage, HoldsTheDataWhateverIsInIt) {
  const TempFolder folder;
  const fs::path run = DriveCorner(folder, "run", "drive: {plants: [kinematic]}\n");
  const std::string plain = ReportPage(ReportData({run}));
  const std::string evil = "<b>&amp;\"'<!--<script>alert(1)</script><img src=x onerror=alert(2)>";
  const fs::path odd = folder.path() / "<b>&\"<img src=x>";
  fs::copy(run, odd);
  ordered_json metrics = ordered_json::parse(ReadFile(run / "metrics.json"));
  metrics["scenario"] = evil;
  metrics["verdict"]["failures"] = {evil};
  WriteFileAtomically(odd / "metrics.json", metrics.dump());
  const ordered_json data = ReportData({odd});
  const std::string page = ReportPage(data);
  EXPECT_EQ(DataIn(page), data);
  EXPECT_EQ(data["runs"][0]["scenario"], evil);
  EXPECT_THAT(page, HasSubstr("<title>&lt;b&gt;&amp;\"&lt;img src=x&gt;</title>"));
  // Apart from the title, the markup is that of any other page.
  const std::regex title("<title>.*</title>");
  EXPECT_EQ(std::regex_replace(Markup(page), title, ""),
            std::regex_replace(Markup(plain), title, ""));
  EXPECT_EQ(Count(page, "</script"), Count(plain, "</script"));
  EXPECT_EQ(Count(page, "<!--"), Count(plain, "<!--"));
}

TEST(ReportPage, TakesWhatIsNoUtf8) {
  const TempFolder folder;
  const fs::path run = DriveCorner(folder, "run", "drive: {plants: [kinematic]}\n");
  const fs::path odd = folder.path() / "latin \xE9";
  fs::copy(run, odd);
  const std::string page = ReportPage(ReportData({odd}));
  EXPECT_EQ(DataIn(page)["runs"][0]["name"], "latin \xEF\xBF\xBD");
  EXPECT_THAT(page, HasSubstr("<title>latin \xEF\xBF\xBD</title>"));
}

TEST(ReportPage, LoadsNothing) {
  const TempFolder folder;
  const std::string page =
      ReportPage(ReportData({DriveCorner(folder, "run", "drive: {plants: [kinematic]}\n")}));
  // Scripts and styles with hashes in the policy: d3, dygraphs, three.js, its camera controls, the
  // page's two scripts and its style. tests/report/hostile_test.py checks the hashes in a browser.
  std::smatch policy;
  ASSERT_TRUE(std::regex_search(
      page, policy, std::regex("http-equiv=\"Content-Security-Policy\" content=\"([^\"]*)\"")));
  EXPECT_THAT(
      policy[1].str(),
      testing::MatchesRegex("default-src 'none'; script-src( 'sha256-[A-Za-z0-9+/]+='){6}; "
                            "style-src 'sha256-[A-Za-z0-9+/]+='; img-src data:; "
                            "media-src 'self' blob: file:; base-uri 'none'; form-action 'none'"));
  const std::string markup = Markup(page);
  const std::regex load(R"re((src|href|action|data)\s*=\s*"([^"]*)")re");
  for (std::sregex_iterator it(markup.begin(), markup.end(), load), end; it != end; ++it) {
    EXPECT_THAT((*it)[2].str(), testing::StartsWith("data:"));
  }
  EXPECT_EQ(Count(markup, "http:") + Count(markup, "https:") + Count(markup, "<link"), 1U)
      << "the icon, which is empty";
  const std::string style = page.substr(page.find("<style>"), page.find("</style>"));
  EXPECT_EQ(Count(style, "@import") + Count(style, "url("), 0U);
}

TEST(ReportPage, StaysSmall) {
  constexpr std::size_t kMaxBytes = 3'000'000;
  const TempFolder folder;
  // Runs of one minute with turns, on two and on three plants, and a comparison of both runs.
  const std::string minute =
      "schema: 1\nname: minute\nmission: {speed: 3, waypoints: [[0, 0], [70, 0], [70, 70], [150, "
      "70]]}\nplan: {method: fillet}\ncontrol: {method: preview}\ndrive: {plants: [kinematic, ";
  const auto drive = [&](const std::string& name, const std::string& others) {
    WriteRunFolder(RunScenario(ParseScenario(minute + others + "]}\n", "minute.yaml", ".")),
                   folder.path() / name);
    return folder.path() / name;
  };
  const fs::path two = drive("two", "mujoco");
  const fs::path three = drive("three", "single_track, mujoco");
  const ordered_json data = ReportData({two});
  for (const ordered_json& plant : data["runs"][0]["plants"]) {
    EXPECT_GE(plant["log"]["t"].back().get<double>(), 60.0);
    EXPECT_GE(plant["log"]["t"].size(), 3000U);  // every period of 20 ms
  }
  // The scripts take the other half of the allowed size.
  EXPECT_LT(data.dump().size(), kMaxBytes / 2);
  EXPECT_LT(ReportPage(data).size(), kMaxBytes);
  EXPECT_LT(ReportPage(ReportData({two, three})).size(), kMaxBytes);
  // A log with ten times as many rows.
  const fs::path run = DriveCorner(folder, "run", "");
  for (const char* plant : {"kinematic", "mujoco"}) {
    LengthenLog(run / (std::string(plant) + ".csv"), 60.0, 0.002);
  }
  EXPECT_LT(ReportPage(ReportData({run})).size(), kMaxBytes);
  const ordered_json log = ReportData({run})["runs"][0]["plants"][0]["log"];
  EXPECT_LE(log["t"].size(), 10000U);  // half of all rows
  EXPECT_GT(log["t"].size(), 3000U);
}

std::string FromBase64(std::string text) {
  using boost::archive::iterators::binary_from_base64;
  using boost::archive::iterators::transform_width;
  using Decoder = transform_width<binary_from_base64<std::string::const_iterator>, 8, 6>;
  const auto padding = static_cast<std::size_t>(std::count(text.begin(), text.end(), '='));
  std::replace(text.begin(), text.end(), '=', 'A');
  std::string bytes(Decoder(text.cbegin()), Decoder(text.cend()));
  return bytes.substr(0, bytes.size() - padding);
}

TEST(WriteReport, PutsTheFilmWhereItIsAsked) {
  const TempFolder folder;
  const fs::path run = DriveCorner(folder, "a run", "drive: {plants: [kinematic]}\n");
  fs::create_directory(folder.path() / "pages");
  const fs::path page = folder.path() / "pages" / "page.html";
  // Test vectors of RFC 4648.
  const std::vector<std::pair<std::string, std::string>> known{
      {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : known) {
    folder.Write("a run/video.mp4", bytes);
    WriteReport({run}, page);
    EXPECT_EQ(DataIn(ReadFile(page))["runs"][0]["film"]["base64"], text);
  }
  std::string film;
  for (int i = 0; i < 1000; ++i) {
    film += static_cast<char>(i * 37 % 256);
  }
  folder.Write("a run/video.mp4", film);
  WriteReport({run}, page);
  EXPECT_EQ(FromBase64(DataIn(ReadFile(page))["runs"][0]["film"]["base64"]), film);
  WriteReport({run}, page, FilmPlace::kBeside);
  EXPECT_EQ(DataIn(ReadFile(page))["runs"][0]["film"]["url"], "../a%20run/video.mp4");
  WriteReport({run}, page, FilmPlace::kAbsent);
  EXPECT_FALSE(DataIn(ReadFile(page))["runs"][0].contains("film"));
}

TEST(WriteReport, RepeatsItself) {
  const TempFolder folder;
  const fs::path run = DriveCorner(folder, "run", "drive: {plants: [kinematic]}\n");
  WriteReport({run}, folder.path() / "a.html");
  WriteReport({run}, folder.path() / "b.html");
  EXPECT_EQ(ReadFile(folder.path() / "a.html"), ReadFile(folder.path() / "b.html"));
  WriteReport({run}, folder.path() / "new" / "a.html");
  EXPECT_EQ(ReadFile(folder.path() / "new" / "a.html"), ReadFile(folder.path() / "b.html"));
  EXPECT_THROW(WriteReport({run}, folder.path() / "a.html" / "a.html"), RunError);
  // An empty folder gives no report.
  EXPECT_THROW(WriteReport({folder.path()}, folder.path() / "gone" / "a.html"), InputError);
  EXPECT_FALSE(fs::exists(folder.path() / "gone"));
}

}  // namespace
}  // namespace trackbed
