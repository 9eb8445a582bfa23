#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/report/run_folders.h"
#include "tests/support/error_text.h"
#include "trackbed/report/report.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;

// Five runs of a search, one of them rejected, and two that shrink its failure.
constexpr const char* kRuns =
    "control.gain,delay,gear,status,robustness,limit,phase,reason\n"
    "5,0.11,2,passed,0.5,car: y,nominal,\n"
    "9.9,0.011,3,passed,0.25,car: y,search,\n"
    "0,1,1,failed,-1,car: y,search,too far\n"
    "10,0.02,2,refused,,,search,no such scenario\n"
    "7,0.11,2,failed,-0.5,car: y,search,far\n"
    "6,0.11,2,failed,-0.01,car: y,shrink,far\n"
    "5.9,0.11,2,passed,0.01,car: y,shrink,\n";

constexpr const char* kSweep =
    R"({"study": "reach", "scenario": "a.yaml", "complete": true, "rows_expected": 7, "versions": {},
        "vary": {"control.gain": {"distribution": "uniform", "from": 0, "to": 10},
                 "delay": {"distribution": "log_uniform", "from": 0.01, "to": 1},
                 "gear": {"distribution": "integer", "from": 1, "to": 3}},
        "search": {"method": "crs2", "runs": 4},
        "nominal": {"control.gain": 5, "delay": 0.11, "gear": 2}})";

ordered_json Outcome() {
  return ordered_json::parse(R"({"study": "reach", "status": "broken", "runs": 5, "shrink_runs": 2,
    "violations": 2, "refused": 1, "errors": 0, "out_of_time": false,
    "first_violation": {"row": 2, "robustness": -1, "limit": "car: y", "settings":
      {"control.gain": 0, "delay": 1, "gear": 1}, "distance": 0.85, "reason": "too far"},
    "least_robust": {"row": 2, "robustness": -1, "limit": "car: y", "settings":
      {"control.gain": 0, "delay": 1, "gear": 1}, "distance": 0.85, "reason": "too far"},
    "counterexample": {"row": 5, "robustness": -0.01, "limit": "car: y", "settings":
      {"control.gain": 6, "delay": 0.11, "gear": 2}, "distance": 0.1, "reason": "far"},
    "shrunk_completely": true, "margins": {
      "control.gain": {"nominal": 5, "counterexample": 6, "holds_up_to": 5.9, "sensitivity": -0.2,
        "alone": {"up": {"holds_up_to": 5.9, "whole_range": false}}},
      "delay": {"nominal": 0.11, "counterexample": 0.11},
      "gear": {"nominal": 2, "counterexample": 2,
        "alone": {"down": {"holds_up_to": 1, "whole_range": true},
                  "up": {"holds_up_to": 3, "whole_range": true}}}}})");
}

class SearchDataTest : public testing::Test {
 protected:
  /// The page's data for a folder with these three files.
  ordered_json Data(const std::string& falsify) {
    folder_.Write("out/sweep.csv", kRuns);
    folder_.Write("out/sweep.json", kSweep);
    folder_.Write("out/falsify.json", falsify);
    return ReportData({folder_.path() / "out"})["study"];
  }

  TempFolder folder_;
};

TEST_F(SearchDataTest, HasTheOutcomeAndTheMargins) {
  const ordered_json study = Data(Outcome().dump());
  const ordered_json& search = study["search"];
  EXPECT_EQ(search["status"], "broken");
  EXPECT_EQ(search["method"], "crs2");
  EXPECT_EQ(search["violations"], 2);
  EXPECT_EQ(search["runs"], 5);
  EXPECT_EQ(search["shrink_runs"], 2);
  EXPECT_EQ(search["counterexample"]["row"], 5);
  EXPECT_EQ(search["counterexample"]["distance"], 0.1);
  EXPECT_EQ(search["counterexample"]["reason"], "far");
  EXPECT_EQ(search["counterexample"]["settings"]["control.gain"], 6);
  EXPECT_FALSE(search.contains("scenario"));
  ASSERT_EQ(search["keys"].size(), 3U);
  const ordered_json& gain = search["keys"][0];
  EXPECT_EQ(gain["column"], 0);
  EXPECT_EQ(gain["nominal"], 5.0);
  EXPECT_EQ(gain["to"], 10.0);
  // No run decreased the gain, so the lower end of `alone` is the nominal value.
  EXPECT_EQ(gain["margin"].dump(), R"({"sensitivity":-0.2,"holds_up_to":5.9,"alone":[5.0,5.9]})");
  EXPECT_EQ(search["keys"][1]["margin"].dump(), R"({"sensitivity":null,"holds_up_to":null})");
  EXPECT_EQ(search["keys"][2]["margin"]["alone"].dump(), "[1.0,3.0]");
  // The points of a search are not a sample, so there are no statistics.
  EXPECT_TRUE(study["statistics"].is_null());
  // The page names the test scenario if its file exists.
  folder_.Write("out/counterexample/counterexample.yaml", "schema: 1\n");
  EXPECT_THAT(Data(Outcome().dump())["search"]["scenario"].get<std::string>(),
              HasSubstr("out/counterexample/counterexample.yaml"));
}

TEST_F(SearchDataTest, CountsWhatWasTriedInEqualIntervals) {
  const ordered_json search = Data(Outcome().dump())["search"];
  // The values 5 and 5.9 are in the sixth tenth of the range from 0 to 10. The rejected run does
  // not count.
  EXPECT_EQ(search["keys"][0]["tried"].dump(), "[1,0,0,0,0,2,1,1,0,1]");
  EXPECT_EQ(search["keys"][0]["failed"].dump(), "[1,0,0,0,0,0,1,1,0,0]");
  // Each bin is a tenth of two decades, so 0.11 is at the fraction log10(11)/2 = 0.52.
  EXPECT_EQ(search["keys"][1]["tried"].dump(), "[1,0,0,0,0,4,0,0,0,1]");
  // With three whole numbers, each number has a bin.
  EXPECT_EQ(search["keys"][2]["tried"].dump(), "[1,4,1]");
  EXPECT_EQ(search["keys"][2]["failed"].dump(), "[1,2,0]");
  // `best` contains only runs of the search, not of the shrinking.
  EXPECT_EQ(search["best"].dump(), "[[0,0.5],[1,0.25],[2,-1.0]]");
}

TEST_F(SearchDataTest, IsOfASearchThatBrokeNothing) {
  ordered_json outcome = Outcome();
  outcome["status"] = "not_falsified";
  for (const char* key : {"first_violation", "counterexample", "shrunk_completely", "margins"}) {
    outcome.erase(key);
  }
  const ordered_json search = Data(outcome.dump())["search"];
  EXPECT_TRUE(search["counterexample"].is_null());
  EXPECT_TRUE(search["first_violation"].is_null());
  EXPECT_EQ(search["least_robust"]["row"], 2);
  EXPECT_FALSE(search["keys"][0].contains("margin"));
}

TEST_F(SearchDataTest, TellsOfAFileThatIsNotOfTheseRuns) {
  const auto error = [&](const ordered_json& outcome) {
    return ErrorText([&] { Data(outcome.dump()); });
  };
  EXPECT_THAT(error(ordered_json::object()), HasSubstr("falsify.json: "));
  ordered_json longer = Outcome();
  longer["shrink_runs"] = 3;
  EXPECT_THAT(error(longer), AllOf(HasSubstr("falsify.json: is of other runs than sweep.csv"),
                                   HasSubstr("7 rows"), HasSubstr("8 runs of reach")));
  ordered_json other = Outcome();
  other["study"] = "another";
  EXPECT_THAT(error(other), HasSubstr("falsify.json: is of other runs than sweep.csv"));
  ordered_json named = Outcome();
  named["margins"].erase("gear");
  EXPECT_THAT(error(named), HasSubstr("falsify.json: "));
}

TEST_F(SearchDataTest, IsNotOfAStudyThatIsNoSearch) {
  Data(Outcome().dump());
  // A sweep that was written into the folder of an earlier search.
  ordered_json sweep = ordered_json::parse(kSweep);
  sweep.erase("search");
  folder_.Write("out/sweep.json", sweep.dump());
  EXPECT_FALSE(ReportData({folder_.path() / "out"})["study"].contains("search"));
  // A table without further files, and a search without falsify.json.
  EXPECT_FALSE(ReportData({folder_.Write("copy.csv", kRuns)})["study"].contains("search"));
  folder_.Write("alone/sweep.csv", kRuns);
  folder_.Write("alone/sweep.json", kSweep);
  EXPECT_FALSE(ReportData({folder_.path() / "alone"})["study"].contains("search"));
}

}  // namespace
}  // namespace trackbed
