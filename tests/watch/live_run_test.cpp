#include "src/watch/live_run.h"

#include <gmock/gmock.h>

#include <future>
#include <limits>
#include <nlohmann/json.hpp>

#include "trackbed/watch/watch.h"

namespace trackbed {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using testing::HasSubstr;
using testing::IsEmpty;

/// Data of a page with one plant. The page shows the times and speeds of the plant's log.
ordered_json OnePlant() {
  const ordered_json plant{{"name", "kinematic"},
                           {"log", {{"t", {0.0}}, {"speed", {0.0}}}},
                           {"motion", {{"channels", {{"x_m", ""}}}}}};
  return {{"runs", {{{"plants", {plant}}}}}};
}

RunLog EmptyLog() {
  return {.plant = "kinematic",
          .controller_columns = {},
          .rows = {},
          .changes = {},
          .configurations = Table({"t_s"})};
}

/// Logs a row and a configuration at each of the times 0, 0.02, ... s. The speed of a row is 7
/// times its index.
void LogRows(const DriveHooks& hooks, int count) {
  RunLog log = EmptyLog();
  Table configurations({"t_s", "x_m"});
  for (int i = 0; i < count; ++i) {
    LogRow row{};
    row.state.time = 0.02 * i;
    row.state.speed = 7.0 * i;
    log.rows.push_back(row);
    configurations.AddRow({row.state.time, 3.0 * i});
    hooks.logged(log, configurations);
  }
}

/// Returns all messages that a page receives until there are no more.
std::vector<json> HearAll(const LiveRun& run, LiveRun::Cursor& cursor) {
  std::vector<json> messages;
  while (const std::optional<std::string> text = run.Next(cursor)) {
    messages.push_back(json::parse(*text));
  }
  return messages;
}

TEST(ParseSpeed, TakesNumbersInRangeAndMax) {
  EXPECT_EQ(ParseSpeed("0.5"), 0.5);
  EXPECT_EQ(ParseSpeed("1000"), 1000.0);
  EXPECT_EQ(ParseSpeed("max"), std::numeric_limits<double>::infinity());
  for (const char* text :
       {"", "0", "-1", "0.001", "1001", "nan", "inf", "1x", " 1", "MAX", "1,5"}) {
    EXPECT_EQ(ParseSpeed(text), std::nullopt) << text;
  }
}

TEST(LiveRun, TellsStateFirstThenRowsOnce) {
  LiveRun run(OnePlant(), "abc", 0.02, 2.5, false);
  run.Interrupt();  // no plant waits for the clock
  LogRows(run.HooksOf("kinematic"), 3);
  LiveRun::Cursor cursor;
  const std::vector<json> messages = HearAll(run, cursor);
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0], json::parse(R"({"type":"state","id":"abc","paused":false,"speed":2.5})"));
  // Poses are sent at most every 1/30 s, so the pose at 0.02 s is omitted.
  EXPECT_EQ(messages[1], json::parse(R"({"type":"rows","plants":[{"first":[0,0,0],
    "rows":[[0,0],[0.02,7],[0.04,14]],"poses":[[0,0],[0.04,6]],"plans":[]}]})"));
}

TEST(LiveRun, TellsWhoComesLaterEverythingAndOthersOnlyWhatIsNew) {
  LiveRun run(OnePlant(), "abc", 0.02, 1.0, false);
  run.Interrupt();
  LogRows(run.HooksOf("kinematic"), 2);
  LiveRun::Cursor first;
  HearAll(run, first);
  EXPECT_THAT(HearAll(run, first), IsEmpty());
  run.Finish();
  EXPECT_EQ(HearAll(run, first), std::vector{json::parse(R"({"type":"finished"})")});
  EXPECT_THAT(HearAll(run, first), IsEmpty());
  LiveRun::Cursor second;
  const std::vector<json> all = HearAll(run, second);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[1]["plants"][0]["rows"].size(), 2U);
  EXPECT_EQ(all[2]["type"], "finished");
}

TEST(LiveRun, DividesManyRowsIntoMessagesOfBoundedSize) {
  constexpr int kRows = 20000;
  LiveRun run(OnePlant(), "abc", 0.02, 1.0, false);
  run.Interrupt();
  LogRows(run.HooksOf("kinematic"), kRows);
  LiveRun::Cursor cursor;
  int rows = 0;
  while (const std::optional<std::string> text = run.Next(cursor)) {
    EXPECT_LT(text->size(), 100000U);
    const json message = json::parse(*text);
    if (message["type"] == "rows") {
      EXPECT_EQ(message["plants"][0]["first"][0], rows);
      rows += static_cast<int>(message["plants"][0]["rows"].size());
    }
  }
  EXPECT_EQ(rows, kRows);
}

TEST(LiveRun, ObeysAndTellsOfIt) {
  LiveRun run(OnePlant(), "abc", 0.02, 1.0, false);
  LiveRun::Cursor cursor;
  const auto state = [&] {
    const std::vector<json> messages = HearAll(run, cursor);
    return messages.empty() ? json() : messages.back();
  };
  EXPECT_EQ(state()["paused"], false);
  EXPECT_EQ(run.Execute(R"({"do":"pause"})"), "");
  EXPECT_EQ(state()["paused"], true);
  EXPECT_EQ(run.Execute(R"({"do":"speed","speed":"max"})"), "");
  EXPECT_EQ(state()["speed"], "max");
  EXPECT_EQ(run.Execute(R"({"do":"speed","speed":0.5})"), "");
  EXPECT_EQ(state()["speed"], 0.5);
  EXPECT_EQ(run.Execute(R"({"do":"resume"})"), "");
  EXPECT_EQ(state()["paused"], false);
  EXPECT_EQ(run.Execute(R"({"do":"step"})"), "");
  EXPECT_EQ(state()["paused"], true);
}

TEST(LiveRun, SaysWhatIsWrongWithAMessage) {
  LiveRun run(OnePlant(), "abc", 0.02, 1.0, true);
  for (const char* message : {"", "{", "[]", "1", "null", "\"pause\"", "{}", R"({"do":1})",
                              "{\"do\":\"\xff\"}", R"({"do":{"do":"pause"}})"}) {
    EXPECT_THAT(run.Execute(message), HasSubstr(R"({"do": "pause"})")) << message;
  }
  EXPECT_THAT(run.Execute(std::string(4000, '[')), HasSubstr("expected an object"));
  EXPECT_THAT(run.Execute(R"({"do":"stop"})"), HasSubstr(R"("resume", "step" or "speed")"));
  for (const char* speed : {"0", "-1", "1e9", "\"5\"", "\"\"", "null", "[]", "true"}) {
    EXPECT_THAT(run.Execute(std::string(R"({"do":"speed","speed":)") + speed + "}"),
                HasSubstr("must be a number from 0.01 to 1000"))
        << speed;
  }
  EXPECT_THAT(run.Execute(R"({"do":"speed"})"), HasSubstr("must be a number"));
  LiveRun::Cursor cursor;
  EXPECT_EQ(HearAll(run, cursor)[0]["speed"], 1.0);  // nothing was done
}

}  // namespace
}  // namespace trackbed
