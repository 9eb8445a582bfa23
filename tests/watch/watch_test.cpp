// Tests watched runs with WebSocket clients in place of pages: streamed rows, commands, several
// pages, interruption and errors.

#include "trackbed/watch/watch.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tests/watch/watched_run.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/report/report.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr double kMax = std::numeric_limits<double>::infinity();

/// A page's data for one plant after all messages so far.
struct Page {
  std::vector<json> rows;
  std::vector<json> poses;

  void Take(const json& plant) {
    Put(plant.at("first")[0], plant.at("rows"), rows);
    Put(plant.at("first")[1], plant.at("poses"), poses);
  }
  static void Put(std::size_t first, const json& added, std::vector<json>& all) {
    ASSERT_EQ(first, all.size());
    all.insert(all.end(), added.begin(), added.end());
  }
};

/// A WebSocket client with the data received so far.
class Listener : public LiveClient {
 public:
  using LiveClient::LiveClient;

  json Hear() {
    json message = LiveClient::Hear();
    if (message.at("type") == "rows") {
      plants.resize(message.at("plants").size());
      for (std::size_t i = 0; i < plants.size(); ++i) {
        plants[i].Take(message.at("plants")[i]);
      }
    }
    return message;
  }
  json HearOf(const std::string& type) {
    json message;
    do {
      message = Hear();
    } while (message.at("type") != type);
    return message;
  }
  /// Receives until every plant has `count` rows.
  void HearRows(std::size_t count) {
    const auto has = [&](const Page& page) { return page.rows.size() >= count; };
    while (plants.empty() || !std::all_of(plants.begin(), plants.end(), has)) {
      Hear();
    }
  }
  /// Receives until the run has ended.
  const std::vector<Page>& HearAll() {
    HearOf("finished");
    return plants;
  }

  std::vector<Page> plants;
};

std::map<std::string, std::string> Files(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name != run_folder::kTimingJson) {
      files[name] = ReadFile(entry.path());
    }
  }
  return files;
}

const std::string kTwoPlants =
    "drive: {plants: [kinematic, mujoco]}\n"
    "expect: {reach_goal: 0.5}\n";

// A watched run writes the same bytes as RunScenario: the clock, pauses and threads change nothing.
TEST(Watch, LeavesTheBytesOfARun) {
  const TempFolder folder;
  const Scenario scenario = Corner(kTwoPlants);
  WriteRunFolder(RunScenario(scenario), folder.path() / "run");
  WatchedRun run(scenario, folder.path() / "watched", {.speed = kMax, .paused = true});
  Listener client(run.port());
  for (std::size_t rows = 1; rows <= 5; ++rows) {
    client.HearRows(rows);
    client.Say(R"({"do":"step"})");
  }
  client.Say(R"({"do":"speed","speed":100})");
  client.Say(R"({"do":"resume"})");
  client.HearRows(20);
  client.Say(R"({"do":"speed","speed":"max"})");
  client.HearOf("finished");
  const RunResult result = run.Interrupt();
  EXPECT_FALSE(result.interrupted);
  EXPECT_EQ(run.finished(), 1);
  const auto expected = Files(folder.path() / "run");
  EXPECT_GT(expected.size(), 8U);
  EXPECT_EQ(Files(folder.path() / "watched"), expected);
}

TEST(Watch, StreamsTheRowsThatTheReportHas) {
  const TempFolder folder;
  const fs::path out = folder.path() / "out";
  WatchedRun run(Corner(kTwoPlants), out, {.speed = kMax, .paused = true});
  Listener client(run.port(), "http://127.0.0.1:" + std::to_string(run.port()));
  client.Say(R"({"do":"resume"})");
  const std::vector<Page>& pages = client.HearAll();
  run.Interrupt();
  const nlohmann::ordered_json report = ReportData({out});
  ASSERT_EQ(pages.size(), 2U);
  for (std::size_t plant = 0; plant < pages.size(); ++plant) {
    const nlohmann::ordered_json& log = report["runs"][0]["plants"][plant]["log"];
    ASSERT_EQ(pages[plant].rows.size(), log["t"].size());
    for (std::size_t row = 0; row < pages[plant].rows.size(); ++row) {
      json expected = json::array();
      for (const auto& channel : log.items()) {
        expected.push_back(channel.value()[row].get<double>());
      }
      ASSERT_EQ(pages[plant].rows[row], expected) << row;
    }
    // Poses are sent at most every 1/30 s; the log has one every 1/60 s.
    const Table states = ReadCsv(out / run_folder::StateCsv(plant == 0 ? "kinematic" : "mujoco"));
    EXPECT_NEAR(static_cast<double>(pages[plant].poses.size()),
                static_cast<double>(states.rows()) / 2.0, 1.0);
    for (std::size_t i = 0; i < pages[plant].poses.size(); ++i) {
      // Values are rounded to 1e-4.
      EXPECT_NEAR(pages[plant].poses[i][0].get<double>(), states.at(2 * i, 0), 0.51e-4);
      EXPECT_NEAR(pages[plant].poses[i][1].get<double>(),
                  states.at(2 * i, static_cast<std::size_t>(states.Find("x_m"))), 0.51e-4);
    }
  }
}

TEST(Watch, StepsByOneControlPeriodAndStops) {
  const TempFolder folder;
  WatchedRun run(Corner(), folder.path() / "out", {.speed = kMax, .paused = true});
  Listener client(run.port());
  for (std::size_t rows = 1; rows <= 10; ++rows) {
    client.HearRows(rows);
    ASSERT_EQ(client.plants[0].rows.size(), rows);
    EXPECT_NEAR(client.plants[0].rows.back()[0].get<double>(),
                0.02 * (static_cast<double>(rows) - 1.0),
                1e-9);  // six digits
    client.Say(R"({"do":"step"})");
  }
  EXPECT_EQ(run.Interrupt().logs.at(0).status, DriveStatus::kInterrupted);
}

TEST(Watch, ShowsTwoPagesTheSameAndObeysBoth) {
  const TempFolder folder;
  WatchedRun run(Corner(), folder.path() / "out", {.speed = kMax, .paused = true});
  Listener first(run.port());
  Listener second(run.port());
  EXPECT_EQ(first.HearOf("state"), second.HearOf("state"));
  first.Say(R"({"do":"speed","speed":7})");
  EXPECT_EQ(second.HearOf("state").at("speed"), 7.0);
  second.Say(R"({"do":"speed","speed":"max"})");
  second.Say(R"({"do":"resume"})");
  while (first.HearOf("state").at("speed") != "max") {  // the server may first report the speed 7
  }
  const std::vector<Page>& one = first.HearAll();
  const std::vector<Page>& other = second.HearAll();
  EXPECT_GT(one[0].rows.size(), 100U);
  EXPECT_EQ(one[0].rows, other[0].rows);
  EXPECT_EQ(one[0].poses, other[0].poses);
}

TEST(Watch, GivesAllRowsToAPageThatComesBack) {
  const TempFolder folder;
  WatchedRun run(Corner(), folder.path() / "out", {.speed = kMax, .paused = true});
  std::vector<Page> before;
  {
    Listener client(run.port());
    client.Say(R"({"do":"step"})");
    client.HearRows(2);
    before = client.plants;
  }  // disconnects without closing
  Listener client(run.port());
  client.Say(R"({"do":"resume"})");
  const std::vector<Page>& after = client.HearAll();
  ASSERT_GT(after[0].rows.size(), 100U);
  EXPECT_EQ(std::vector(after[0].rows.begin(), after[0].rows.begin() + 2), before[0].rows);
  // A client that connects after the end gets all rows, too.
  Listener late(run.port());
  EXPECT_EQ(late.HearAll()[0].rows, after[0].rows);
}

TEST(Watch, ServesThePageOfTheRunAndThenItsReport) {
  const TempFolder folder;
  const fs::path out = folder.path() / "out";
  WatchedRun run(Corner(kTwoPlants), out, {.speed = kMax, .paused = true});
  const Answer live = Get(run.port(), "/");
  EXPECT_EQ(live.result(), http::status::ok);
  EXPECT_THAT(live.body(), HasSubstr("connect-src 'self'"));
  EXPECT_THAT(live.body(), HasSubstr("new WebSocket("));
  EXPECT_THAT(live.body(), HasSubstr("\"name\":\"out\""));
  EXPECT_EQ(live["Cache-Control"], "no-store");
  EXPECT_EQ(live["X-Frame-Options"], "DENY");
  LiveClient client(run.port());
  client.Say(R"({"do":"resume"})");
  client.HearOf("finished");
  const Answer report = Get(run.port(), "/");
  run.Interrupt();
  const fs::path file = folder.path() / "report.html";
  WriteReport({out}, file);
  EXPECT_EQ(report.body(), ReadFile(file));
  EXPECT_THAT(report.body(), Not(HasSubstr("connect-src")));
  EXPECT_THAT(report.body(), Not(HasSubstr("new WebSocket(")));
}

TEST(Watch, KeepsTheLogOfAnInterruptedRun) {
  const TempFolder folder;
  const fs::path out = folder.path() / "out";
  WatchedRun run(Corner(kTwoPlants), out, {.speed = kMax, .paused = true});
  Listener client(run.port());
  client.Say(R"({"do":"step"})");
  client.HearRows(2);
  const RunResult result = run.Interrupt();
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(run.finished(), 1);
  EXPECT_EQ(json::parse(ReadFile(out / "metrics.json")).at("complete"), false);
  EXPECT_GE(ReadCsv(out / "mujoco.csv").rows(), 2U);
  EXPECT_THAT(folder.Names(), testing::ElementsAre("out"));
  for (const auto& entry : fs::directory_iterator(out)) {
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
  }
}

TEST(Watch, LeavesTheEarlierResultUntilTheRunHasEnded) {
  const TempFolder folder;
  const fs::path out = folder.path() / "out";
  WriteRunFolder(RunScenario(Corner()), out);
  const auto before = Files(out);
  WatchedRun run(Corner("drive: {plants: [kinematic]}\nseed: 5\n"), out, {.paused = true});
  LiveClient client(run.port());
  client.HearOf("rows");
  EXPECT_EQ(Files(out), before);
  EXPECT_THROW(OutputFolder{out}, RunError);  // locked by this run
  run.Interrupt();
  EXPECT_NE(Files(out), before);
}

TEST(Watch, ReportsAMissionThatCannotBePlanned) {
  const TempFolder folder;
  const fs::path out = folder.path() / "out";
  const Scenario scenario = ParseScenario(
      "schema: 1\n"
      "name: corner\n"
      "mission: {speed: 3, waypoints: [[0, 0], [2, 0], [2, 2]]}\n"  // too tight a turn
      "plan: {method: fillet}\n",
      "corner.yaml", ".");
  WatchedRun run(scenario, out, {});
  const Answer page = Get(run.port(), "/");
  EXPECT_EQ(page.result(), http::status::ok);
  EXPECT_THAT(page.body(), HasSubstr("no plan"));
  EXPECT_THROW(LiveClient{run.port()}, boost::system::system_error);
  const RunResult result = run.Interrupt();
  EXPECT_FALSE(result.plan.ok());
  EXPECT_FALSE(result.interrupted);
  EXPECT_EQ(run.finished(), 1);
}

TEST(Watch, SaysThatAPortIsInUse) {
  const TempFolder folder;
  WatchedRun run(Corner(), folder.path() / "out", {.paused = true});
  try {
    WatchReport({folder.path() / "out"}, {.port = run.port()}, {});
    FAIL() << "two servers on one port";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot listen on 127.0.0.1 port " +
                                        std::to_string(run.port()) + ": Address already in use"));
  }
}

TEST(Watch, RefusesWhatIsNoAddress) {
  EXPECT_THROW(WatchReport({"nowhere"}, {.host = "example.org"}, {}), InputError);
  EXPECT_THROW(WatchReport({"nowhere"}, {.host = ""}, {}), InputError);
}

TEST(Watch, ServesAFinishedRun) {
  const TempFolder folder;
  const fs::path out = folder.path() / "out";
  WriteRunFolder(RunScenario(Corner()), out);
  std::future<std::string> body;
  WatchReport(
      {out}, {},
      {.serving =
           [&](const std::string& url) {
             // The server already listens when it calls `serving`, and answers as soon as it
             // serves.
             body = std::async(std::launch::async, [url] { return Get(PortOf(url), "/").body(); });
           },
       .interrupted =
           [&] { return body.wait_for(std::chrono::seconds(0)) == std::future_status::ready; },
       .finished = {}});
  const fs::path file = folder.path() / "report.html";
  WriteReport({out}, file);
  EXPECT_EQ(body.get(), ReadFile(file));
}

TEST(Watch, PassesErrorsOnFromAFolderThatIsNoRun) {
  const TempFolder folder;
  EXPECT_THROW(WatchReport({folder.path()}, {}, {}), InputError);
}

}  // namespace
}  // namespace trackbed
