#include <gmock/gmock.h>

#include <string>

#include "tests/cli/program.h"

namespace trackbed {
namespace {

using testing::HasSubstr;

TEST(WatchProgram, PrintsWhereItServesAndEndsWithCtrlC) {
  for (const char* signal : {"INT", "TERM", "HUP"}) {
    const TempFolder folder;
    const Outcome outcome =
        Watched(folder, "'" + ScenarioFile("three_turns") + "' --paused", signal);
    EXPECT_THAT(outcome.output, testing::ContainsRegex(R"(^http://127\.0\.0\.1:[0-9]+/ )"));
    EXPECT_THAT(outcome.output, HasSubstr("three_turns: interrupted, in out/three_turns\n"));
    EXPECT_EQ(outcome.code, 130) << signal;
  }
}

TEST(WatchProgram, GivesTheExitCodeOfARunThatHasEnded) {
  const TempFolder folder;
  folder.Write("tight.yaml",
               "schema: 1\nname: tight\nmission: {speed: 3, waypoints: [[0, 0], [2, 0], [2, 2]]}\n"
               "plan: {method: fillet}\n");
  const Outcome outcome = Watched(folder, "tight.yaml");
  EXPECT_THAT(outcome.output, HasSubstr("tight: FAILED, in out/tight\n  no plan (turn_too_tight)"));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(Watched(folder, "out/tight").code, 0);
}

TEST(WatchProgram, RefusesWhatItCannotServe) {
  const TempFolder folder;
  const std::string scenario = "'" + ScenarioFile("three_turns") + "'";
  folder.Write("empty/note.txt", "");
  for (const auto& [arguments, message] :
       {std::pair<std::string, std::string>{"", "missing SCENARIO"},
        {scenario + " --speed 0", "--speed: '0' must be a number from 0.01 to 1000, or max"},
        {scenario + " --speed fast", "--speed: 'fast' must be"},
        {scenario + " --host example.org", "--host: 'example.org' is not an IP address"},
        {scenario + " --port 65536", "65536"},
        {scenario + " --port -1", "-1"},
        {"nothing.yaml", "nothing.yaml"},
        {"three_turn", "did you mean 'three_turns'?"},
        {"empty", "not a finished run"},
        {"empty --paused", "is a finished result"}}) {
    const Outcome outcome = Trackbed(folder, "watch " + arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_THAT(outcome.output, HasSubstr(message)) << arguments;
  }
}

}  // namespace
}  // namespace trackbed
